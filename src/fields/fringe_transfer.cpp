#include "fields/fringe_transfer.hpp"

#include "core/mathematics/units.hpp"
#include "core/threads/parallel_list.hpp"
#include "optics/waves/quadrature.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace vkfv::fields {

namespace {

constexpr double most_phase = 0.8; // rad, from node to node at the ends of the range: cubic weights are then off by
                                   // 1e-2 there, and by 1e-4 in its middle half
constexpr int frequency_steps = 256;
constexpr double edge_nodes = 2; // nodes beyond the last wave number, which cubic weights reach

double wave_number_of(double wavelength) {
    return 2 * pi / wavelength;
}

// Weights of the four nodes about a place t in [0, 1] between the second and the third: Lagrange's cubic.
std::array<double, 4> cubic_weights(double t) {
    return {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2, -(t + 1) * t * (t - 2) / 2,
            (t + 1) * t * (t - 1) / 6};
}

// The phase (rad) of the glass that the reference arm has more of, less its value and its delay at the reference.
double glass_phase(const ReferenceArm& arm, double wavelength_um, double reference_um) {
    if (!arm.glass || arm.glass_thickness == 0) {
        return 0;
    }
    const auto path = [&](double um) { return wave_number_of(um * mm_per_um) * arm.glass->index(um); };
    constexpr double apart = 1e-3; // of the wavelength, for the derivative
    const double k = wave_number_of(wavelength_um * mm_per_um), k_reference = wave_number_of(reference_um * mm_per_um);
    const double shorter = reference_um * (1 - apart), longer = reference_um * (1 + apart);
    const double delay =
        (path(shorter) - path(longer)) / (wave_number_of(shorter * mm_per_um) - wave_number_of(longer * mm_per_um));
    return 2 * arm.glass_thickness * (path(wavelength_um) - path(reference_um) - delay * (k - k_reference));
}

} // namespace

// An even polynomial's values at evenly spaced squares of the radius, linear in between.
class FringeTransfer::RadialPath {
  public:
    explicit RadialPath(const optics::Wavefront& wavefront, double rim) : per_square_(samples / (rim * rim)) {
        for (int k = 0; k <= samples; ++k) {
            const double radius = std::min(std::sqrt(k / per_square_), rim * (1 - 1e-9));
            paths_[static_cast<std::size_t>(k)] = wavefront.path(glm::dvec2(radius, 0));
        }
    }
    double at(double square) const {
        const double place = std::min(square * per_square_, samples - 1e-6);
        const auto below = static_cast<std::size_t>(place);
        const double share = place - static_cast<double>(below);
        return paths_[below] + share * (paths_[below + 1] - paths_[below]);
    }

  private:
    static constexpr int samples = 512;
    double per_square_;
    std::array<double, samples + 1> paths_{};
};

struct FringeTransfer::Pupil {
    double wave_number = 0; // 1/mm
    double square_index = 1;
    double pupil_rim = 0, source_rim = 0, dark_rim = 0; // of |p|
    double weight = 0;                                  // over the source's area
    double half_range = 0, centre = 0;
    double defocus = 0;     // mm
    double phase = 0;       // rad
    const RadialPath* path; // W
};

int wavelengths_for(double shortest_um, double longest_um, double half_range) {
    const double span = wave_number_of(shortest_um * mm_per_um) - wave_number_of(longest_um * mm_per_um);
    return std::clamp(static_cast<int>(std::ceil(2 * span * half_range)), 16, 512);
}

FringeTransfer::FringeTransfer(std::span<const optics::Wavefront> wavefronts, const ReferenceArm& arm,
                               double source_fill, double centre, double half_range, double reference_um)
    : steps_(frequency_steps) {
    double least = 1e300, most = 0;
    for (const auto& wavefront : wavefronts) {
        const double k = wave_number_of(wavefront.wavelength()), n = wavefront.index(), rim = wavefront.rim(0);
        least = std::min(least, 2 * k * std::sqrt(n * n - rim * rim));
        most = std::max(most, 2 * k * n);
        cutoff_ = std::max(cutoff_, rim * (1 + std::min(1.0, source_fill)) / wavefront.wavelength());
    }
    spacing_ = most_phase / half_range;
    first_ = least - edge_nodes * spacing_;
    nodes_ = static_cast<int>(std::ceil((most - first_) / spacing_ + edge_nodes)) + 1;
    values_.resize(static_cast<std::size_t>(steps_ + 1) * static_cast<std::size_t>(nodes_));
    std::vector<RadialPath> paths;
    paths.reserve(wavefronts.size());
    std::vector<Pupil> pupils;
    for (const auto& wavefront : wavefronts) {
        const double rim = wavefront.rim(0), lit = rim * std::min(1.0, source_fill), dark = rim * arm.obscuration;
        paths.emplace_back(wavefront, rim);
        pupils.push_back({.wave_number = wave_number_of(wavefront.wavelength()),
                          .square_index = wavefront.index() * wavefront.index(),
                          .pupil_rim = rim,
                          .source_rim = lit,
                          .dark_rim = dark,
                          .weight = wavefront.weight() / (pi * (lit * lit - dark * dark)),
                          .half_range = half_range,
                          .centre = centre,
                          .defocus = arm.defocus,
                          .phase = glass_phase(arm, wavefront.wavelength() * um_per_mm, reference_um),
                          .path = &paths.back()});
    }
    parallel_items(steps_ + 1, [&](int step) {
        for (const Pupil& pupil : pupils) {
            add(static_cast<std::size_t>(step), pupil, cutoff_ * step / steps_);
        }
    });
}

namespace {

// The heights y >= 0 between which the overlap of two discs has borders without corners: the disc of radius `first`
// about the origin, and the disc of radius `second` about (-apart, 0). Empty if they do not overlap.
std::vector<double> borders_of_overlap(double first, double second, double apart) {
    if (first <= 0 || second <= 0 || apart >= first + second) {
        return {};
    }
    const double top = apart * apart + first * first <= second * second   ? first
                       : apart * apart + second * second <= first * first ? second
                                                                          : 0;
    std::vector<double> borders{0};
    if (apart > std::abs(first - second)) { // the circles meet
        const double meet = (first * first - second * second + apart * apart) / (2 * apart);
        borders.push_back(std::sqrt(std::max(0.0, first * first - meet * meet)));
    }
    if (top > borders.back()) {
        borders.push_back(top);
    }
    return borders;
}

} // namespace

void FringeTransfer::add(std::size_t step, const Pupil& pupil, double frequency) {
    const double apart = 2 * pi * frequency / pupil.wave_number; // |p - s|
    const double n = std::sqrt(pupil.square_index);
    const double phase_across = 2 * pupil.wave_number *
                                (n - std::sqrt(pupil.square_index - pupil.pupil_rim * pupil.pupil_rim)) *
                                (pupil.half_range + std::abs(pupil.centre) + std::abs(pupil.defocus));
    const auto rule = optics::gauss_legendre(std::min(400, 20 + static_cast<int>(phase_across / 2)));
    std::complex<double>* const nodes = &values_[step * static_cast<std::size_t>(nodes_)];
    const auto add_row = [&](double y, double from, double to, double weight) {
        for (const auto& across : rule) {
            const double s_x = (from + to) / 2 + (to - from) / 2 * across.place, p_x = s_x + apart;
            const double s_square = s_x * s_x + y * y, p_square = p_x * p_x + y * y;
            const double gamma_s = std::sqrt(pupil.square_index - s_square);
            const double gamma_p = std::sqrt(pupil.square_index - p_square);
            const double q_z = pupil.wave_number * (gamma_s + gamma_p);
            const double phase = q_z * pupil.centre - pupil.phase +
                                 pupil.wave_number * (pupil.path->at(p_square) - pupil.path->at(s_square) -
                                                      2 * pupil.defocus * (gamma_s - n));
            const std::complex<double> value = std::polar(weight * (to - from) / 2 * across.weight, phase);
            const double place = (q_z - first_) / spacing_;
            const auto below = static_cast<std::size_t>(place);
            const auto weights = cubic_weights(place - static_cast<double>(below));
            for (std::size_t k = 0; k < weights.size(); ++k) {
                nodes[below - 1 + k] += weights[k] * value;
            }
        }
    };
    // Source and pupil are rings, each the difference of two discs; s lies in the first and s + (apart, 0) in the
    // second. Each overlap of two discs is integrated between its exact borders.
    const auto add_overlap = [&](double of_source, double of_pupil, double sign) {
        const auto borders = borders_of_overlap(of_source, of_pupil, apart);
        for (std::size_t k = 0; k + 1 < borders.size(); ++k) {
            // With y = top sin(angle) the length of a row is smooth at a pole of a disc.
            const double top = borders[k + 1], low = std::asin(borders[k] / top), half = (pi / 2 - low) / 2;
            for (const auto& along : rule) {
                const double angle = low + half * (1 + along.place), y = top * std::sin(angle);
                const double source_x = std::sqrt(std::max(0.0, of_source * of_source - y * y));
                const double pupil_x = std::sqrt(std::max(0.0, of_pupil * of_pupil - y * y));
                const double from = std::max(-source_x, -apart - pupil_x), to = std::min(source_x, pupil_x - apart);
                if (to > from) {
                    add_row(y, from, to, 2 * sign * pupil.weight * along.weight * half * top * std::cos(angle));
                }
            }
        }
    };
    add_overlap(pupil.source_rim, pupil.pupil_rim, 1);
    add_overlap(pupil.dark_rim, pupil.pupil_rim, -1);
    add_overlap(pupil.source_rim, pupil.dark_rim, -1);
    add_overlap(pupil.dark_rim, pupil.dark_rim, 1);
}

std::complex<double> FringeTransfer::at(int node, double frequency) const {
    const double place = frequency / cutoff_ * steps_;
    if (!(place < steps_)) {
        return 0;
    }
    const auto below = static_cast<std::size_t>(place);
    const double share = place - static_cast<double>(below);
    const std::size_t k = below * static_cast<std::size_t>(nodes_) + static_cast<std::size_t>(node);
    return values_[k] + share * (values_[k + static_cast<std::size_t>(nodes_)] - values_[k]);
}

} // namespace vkfv::fields
