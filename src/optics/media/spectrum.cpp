#include "optics/media/spectrum.hpp"

#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vkfv::optics {

namespace {

using physics::f64::SpectralBin;

constexpr int gaussian_bins = 128; // a linear density over 1/16 standard deviation is accurate to 5e-4
// Standard deviation of a Gaussian over its full width at half maximum: 1 / (2 sqrt(2 ln 2)).
constexpr double sigma_per_full_width = 0.42466090014400953;

[[noreturn]] void refuse(std::string found, std::string expected) {
    throw InputError({.where = {},
                      .key = "source.spectrum",
                      .found = std::move(found),
                      .expected = std::move(expected),
                      .remedy = "Correct the spectrum."});
}

void require_ascending(const std::vector<double>& wavelengths, const std::vector<double>& values) {
    if (wavelengths.empty() || wavelengths.size() != values.size()) {
        refuse(fmt::format("{} wavelengths and {} values", wavelengths.size(), values.size()),
               "as many values as wavelengths, at least one");
    }
    if (wavelengths.size() > static_cast<std::size_t>(physics::f64::SPECTRUM_CAPACITY)) {
        refuse(fmt::format("{} wavelengths", wavelengths.size()),
               fmt::format("at most {}", physics::f64::SPECTRUM_CAPACITY));
    }
    for (std::size_t i = 0; i < wavelengths.size(); ++i) {
        if (!(wavelengths[i] > (i > 0 ? wavelengths[i - 1] : 0.0) && std::isfinite(wavelengths[i]))) {
            refuse(fmt::format("wavelength {} um", wavelengths[i]), "positive wavelengths, ascending");
        }
        if (!(values[i] >= 0 && std::isfinite(values[i]))) {
            refuse(fmt::format("{} at {} um", values[i], wavelengths[i]), "finite values >= 0");
        }
    }
}

// Turns the bins' shares into cumulative shares; the last is set to 1, which rounding would miss.
Spectrum finish(std::vector<SpectralBin> bins, double mean_times_total, double total) {
    if (!(total > 0)) {
        refuse("no flux", "a spectrum with some flux");
    }
    double sum = 0;
    for (SpectralBin& bin : bins) {
        sum += bin.cumulative;
        bin.cumulative = sum / total;
    }
    bins.back().cumulative = 1;
    Spectrum spectrum;
    spectrum.reference_um = mean_times_total / total;
    spectrum.shortest_um = bins.front().start;
    spectrum.longest_um = bins.back().stop;
    spectrum.bins = std::move(bins);
    return spectrum;
}

} // namespace

double Spectrum::half_width() const {
    return monochromatic()
               ? 1
               : std::max(1 / (shortest_um * shortest_um) - centre(), centre() - 1 / (longest_um * longest_um));
}

Spectrum Spectrum::line(double wavelength_um) {
    return lines({wavelength_um}, {1.0});
}

Spectrum Spectrum::lines(const std::vector<double>& wavelengths_um, const std::vector<double>& weights) {
    require_ascending(wavelengths_um, weights);
    std::vector<SpectralBin> bins;
    double total = 0;
    double moment = 0;
    for (std::size_t i = 0; i < wavelengths_um.size(); ++i) {
        if (weights[i] > 0) {
            bins.push_back(
                {.cumulative = weights[i], .start = wavelengths_um[i], .stop = wavelengths_um[i], .tilt = 0});
            total += weights[i];
            moment += weights[i] * wavelengths_um[i];
        }
    }
    Spectrum spectrum = finish(std::move(bins), moment, total);
    if (spectrum.monochromatic()) {
        spectrum.reference_um = spectrum.shortest_um; // exact, where the mean would be rounded
    }
    return spectrum;
}

Spectrum Spectrum::gaussian(double centre_um, double full_width_um) {
    const double sigma = full_width_um * sigma_per_full_width;
    if (!(sigma > 0 && centre_um > gaussian_reach * sigma && std::isfinite(centre_um))) {
        refuse(fmt::format("centre {} um, full width {} um", centre_um, full_width_um),
               fmt::format("a full width > 0 and below {:.3g} of the centre",
                           1 / (gaussian_reach * sigma_per_full_width)));
    }
    std::vector<double> wavelengths;
    std::vector<double> densities;
    for (int i = 0; i <= gaussian_bins; ++i) {
        const double t = gaussian_reach * (2.0 * i / gaussian_bins - 1);
        wavelengths.push_back(centre_um + t * sigma);
        densities.push_back(std::exp(-0.5 * t * t));
    }
    Spectrum spectrum = table(wavelengths, densities);
    spectrum.reference_um = centre_um;
    return spectrum;
}

Spectrum Spectrum::table(const std::vector<double>& wavelengths_um, const std::vector<double>& densities) {
    require_ascending(wavelengths_um, densities);
    if (wavelengths_um.size() < 2) {
        refuse("one wavelength", "a table of at least two wavelengths");
    }
    std::vector<SpectralBin> bins;
    double total = 0;
    double moment = 0;
    for (std::size_t i = 0; i + 1 < wavelengths_um.size(); ++i) {
        const double width = wavelengths_um[i + 1] - wavelengths_um[i];
        const double sum = densities[i] + densities[i + 1];
        if (sum > 0) {
            const double share = 0.5 * sum * width;
            const double tilt = (densities[i + 1] - densities[i]) / sum;
            bins.push_back(
                {.cumulative = share, .start = wavelengths_um[i], .stop = wavelengths_um[i + 1], .tilt = tilt});
            total += share;
            // The mean of a density that rises from 1 - tilt to 1 + tilt lies tilt / 6 of the width off the middle.
            moment += share * (wavelengths_um[i] + width * (0.5 + tilt / 6));
        }
    }
    return finish(std::move(bins), moment, total);
}

Spectrum Spectrum::mixture(const std::vector<Part>& parts) {
    const auto differs = [&](const Part& part) { return !(part.spectrum == parts.front().spectrum); };
    if (std::ranges::none_of(parts, differs)) {
        return parts.front().spectrum;
    }
    std::vector<SpectralBin> bins;
    double total = 0;
    double moment = 0;
    double longest = 0;
    for (const auto& [flux, spectrum] : parts) {
        double before = 0;
        for (SpectralBin bin : spectrum.bins) {
            const double share = bin.cumulative - before;
            before = bin.cumulative;
            bin.cumulative = flux * share;
            bins.push_back(bin);
        }
        total += flux;
        moment += flux * spectrum.reference_um;
        longest = std::max(longest, spectrum.longest_um);
    }
    std::ranges::stable_sort(bins, {}, &SpectralBin::start);
    Spectrum mixture = finish(std::move(bins), moment, total);
    mixture.longest_um = longest;
    return mixture;
}

bool Spectrum::operator==(const Spectrum& other) const {
    return reference_um == other.reference_um &&
           std::ranges::equal(bins, other.bins, [](const SpectralBin& a, const SpectralBin& b) {
               return a.cumulative == b.cumulative && a.start == b.start && a.stop == b.stop && a.tilt == b.tilt;
           });
}

SpectralIndex spectral_index(const Medium& medium, const Spectrum& spectrum) {
    SpectralIndex result{.centre = medium.index(spectrum.reference_um)};
    if (spectrum.monochromatic()) {
        return result;
    }
    constexpr int terms = 6;
    const auto x_of = [&](double wavelength) {
        return (1 / (wavelength * wavelength) - spectrum.centre()) / spectrum.half_width();
    };
    const double low = x_of(spectrum.longest_um);
    const double high = x_of(spectrum.shortest_um);
    // The quotient (n(x) - n(0)) / x is interpolated by a polynomial at Chebyshev's nodes, in Newton's divided
    // differences.
    std::array<double, terms> nodes{};
    std::array<double, terms> differences{};
    for (int k = 0; k < terms; ++k) {
        double x = 0.5 * (low + high) + 0.5 * (high - low) * std::cos(pi * (k + 0.5) / terms);
        if (std::abs(x) < 1e-3 * (high - low)) {
            x = 1e-3 * (high - low); // a node at 0 would divide by zero
        }
        nodes[k] = x;
        const double wavelength = 1 / std::sqrt(spectrum.centre() + x * spectrum.half_width());
        differences[k] = (medium.index(wavelength) - result.centre) / x;
    }
    for (int order = 1; order < terms; ++order) {
        for (int k = terms - 1; k >= order; --k) {
            differences[k] = (differences[k] - differences[k - 1]) / (nodes[k] - nodes[k - order]);
        }
    }
    // The polynomial is converted from Newton's form to powers of x.
    std::array<double, terms> powers{};
    for (int k = terms - 1; k >= 0; --k) {
        for (int j = terms - 1; j > 0; --j) {
            powers[j] = powers[j - 1] - nodes[k] * powers[j];
        }
        powers[0] = differences[k] - nodes[k] * powers[0];
    }
    result.dispersion = {powers[0], powers[1], powers[2], powers[3], powers[4], powers[5]};
    return result;
}

std::vector<SpectralNode> spectral_nodes(const std::vector<physics::f64::SpectralBin>& bins, double centre,
                                         double half_width, int fewest) {
    const int per_bin = (fewest + static_cast<int>(bins.size()) - 1) / static_cast<int>(bins.size());
    std::vector<SpectralNode> nodes;
    double before = 0;
    for (const auto& bin : bins) {
        const int count = bin.start == bin.stop ? 1 : per_bin;
        for (int i = 0; i < count; ++i) {
            const double wavelength = physics::f64::wavelength_in_bin(bin, (i + 0.5) / count);
            nodes.push_back({.spectral = (1 / (wavelength * wavelength) - centre) / half_width,
                             .wavelength_um = wavelength,
                             .weight = (bin.cumulative - before) / count});
        }
        before = bin.cumulative;
    }
    return nodes;
}

std::vector<SpectralNode> at_most(int most, const std::vector<SpectralNode>& nodes) {
    if (nodes.size() <= static_cast<std::size_t>(most)) {
        return nodes;
    }
    std::vector<SpectralNode> groups(static_cast<std::size_t>(most), SpectralNode{});
    double before = 0;
    for (const SpectralNode& node : nodes) {
        const auto group = static_cast<std::size_t>(std::min(most - 1.0, (before + 0.5 * node.weight) * most));
        before += node.weight;
        groups[group].spectral += node.weight * node.spectral;
        groups[group].wavelength_um += node.weight * node.wavelength_um;
        groups[group].weight += node.weight;
    }
    std::erase_if(groups, [](const SpectralNode& group) { return group.weight == 0; });
    for (SpectralNode& group : groups) {
        group.spectral /= group.weight;
        group.wavelength_um /= group.weight;
    }
    return groups;
}

} // namespace vkfv::optics
