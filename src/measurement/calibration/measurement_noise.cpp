// Measurement noise N_M: ISO 25178-600, by the subtraction method of ISO 25178-700.
#include "core/mathematics/units.hpp"
#include "measurement/calibration/standards.hpp"
#include "surface/filter.hpp"
#include "surface/height_parameters.hpp"

#include <fmt/format.h>

#include <cmath>

namespace vkfv::measurement {

namespace {
namespace of_noise { // files of a unity build share the unnamed namespace

std::vector<double> contrasts_of(const Conditions& conditions) {
    return conditions.small ? std::vector{usual_contrast} : std::vector{0.05, 0.1, usual_contrast};
}

int repetitions_of(const Conditions& conditions) {
    return conditions.small ? 5 : 10;
}

std::vector<Trial> trials(const Conditions& conditions, std::vector<std::string>& /*remarks*/) {
    std::vector<Trial> list;
    for (const double contrast : contrasts_of(conditions)) {
        for (int k = 0; k < repetitions_of(conditions); ++k) {
            list.push_back({.name = fmt::format("contrast_{:.0f}/repeat_{:02}", 100 * contrast, k),
                            .specimen = standard_of(conditions, "plane", "", 0) + printed(conditions, contrast, 1),
                            .overrides = repetition(conditions, k)});
        }
    }
    return list;
}

// Sq of the difference of two measurements over the square root of 2, mm.
double noise_of_pair(const surface::HeightMap& a, const surface::HeightMap& b, double s_filter) {
    surface::HeightMap difference = a;
    for (std::size_t k = 0; k < difference.height.values.size(); ++k) {
        difference.height.values[k] -= b.height.values[k];
    }
    difference = surface::remove_plane(difference, surface::least_squares_plane(difference));
    if (s_filter > 0) {
        difference = surface::gaussian_low_pass(difference, s_filter);
    }
    return surface::height_parameters(difference).sq / std::sqrt(2.0);
}

struct Noise {
    double value = 0, standard_uncertainty = 0; // mm
};

// The root mean square over all pairs, with its standard error by the jackknife over the measurements (Efron 1982).
Noise noise_of(std::span<const TrialResult> repeats, double s_filter) {
    const std::size_t count = repeats.size();
    std::vector<double> of_measurement(count); // sums of squares over the pairs of each measurement
    double all = 0;
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = i + 1; j < count; ++j) {
            const double square = std::pow(noise_of_pair(repeats[i].heights, repeats[j].heights, s_filter), 2);
            all += square;
            of_measurement[i] += square;
            of_measurement[j] += square;
        }
    }
    const auto n = static_cast<double>(count);
    const double pairs = n * (n - 1) / 2, pairs_without_one = (n - 1) * (n - 2) / 2;
    double mean = 0, squares = 0;
    for (const double own : of_measurement) {
        mean += std::sqrt((all - own) / pairs_without_one) / n;
    }
    for (const double own : of_measurement) {
        squares += std::pow(std::sqrt((all - own) / pairs_without_one) - mean, 2);
    }
    return {.value = std::sqrt(all / pairs), .standard_uncertainty = std::sqrt((n - 1) / n * squares)};
}

Findings evaluate(const Conditions& conditions, std::span<const TrialResult> results) {
    const int repetitions = repetitions_of(conditions);
    Findings findings;
    CertificateTable table{.caption = "Measurement noise over the contrast of the print",
                           .columns = {"contrast / %", "measured / %", "N_M / nm", "u / nm",
                                       "N_M after the S-filter / nm", "u / nm", "stated noise of a height / nm"},
                           .rows = {}};
    report::Curve raw{.name = "N_M", .points = {}, .spreads = {}, .markers = true};
    report::Curve smooth{.name = "after the S-filter", .points = {}, .spreads = {}, .markers = true};
    std::size_t first = 0;
    for (const double contrast : contrasts_of(conditions)) {
        const auto repeats = results.subspan(first, static_cast<std::size_t>(repetitions));
        first += repeats.size();
        const Noise of_points = noise_of(repeats, 0), of_waves = noise_of(repeats, conditions.s_filter());
        constexpr double nm = 1e6;
        table.rows.push_back({100 * contrast, 100 * repeats.front().measured_share, of_points.value * nm,
                              of_points.standard_uncertainty * nm, of_waves.value * nm,
                              of_waves.standard_uncertainty * nm, repeats.front().height_noise * nm});
        raw.points.emplace_back(100 * contrast, of_points.value * nm);
        smooth.points.emplace_back(100 * contrast, of_waves.value * nm);
        const auto figure = [&](const char* filtered, const std::string& words, const Noise& noise) {
            findings.figures.push_back({.key = fmt::format("N_M{}_at_{:.0f}_percent_nm", filtered, 100 * contrast),
                                        .title = fmt::format("N_M{}, contrast {:.0f} %", words, 100 * contrast),
                                        .unit = "nm",
                                        .value = noise.value * nm,
                                        .standard_uncertainty = noise.standard_uncertainty * nm,
                                        .degrees_of_freedom = repetitions - 1.0});
        };
        figure("", "", of_points);
        figure("_filtered", fmt::format(", S-filter {:.3g} µm", conditions.s_filter() * um_per_mm), of_waves);
    }
    if (table.rows.size() > 1) {
        findings.charts.push_back({.title = "Measurement noise over the contrast of the print",
                                   .x_label = "contrast / %",
                                   .y_label = "N_M / nm",
                                   .curves = {raw, smooth}});
    }
    findings.tables.push_back(std::move(table));
    findings.remarks.push_back(
        conditions.camera ? "The repetitions are images of the same light: noise of the traced rays is common to them "
                            "and is not part of N_M."
                          : "Without [camera] the only noise is that of the traced rays.");
    return findings;
}

} // namespace of_noise
} // namespace

Characteristic measurement_noise() {
    return {.name = "N_M",
            .title = "Measurement noise",
            .standard = "A level flat with a printed texture (type AFL), not moved between the measurements.",
            .procedure = "The difference of each pair of measurements is levelled by its least-squares plane; its Sq "
                         "over the square root of 2 is the noise. N_M is the root mean square over all pairs, and its "
                         "standard uncertainty that of the jackknife over the measurements.",
            .equation = R"(N_M = \sqrt{\frac{1}{n (n - 1)} \sum_{i < j} S_q^2(z_i - z_j)})",
            .trials = of_noise::trials,
            .evaluate = of_noise::evaluate};
}

} // namespace vkfv::measurement
