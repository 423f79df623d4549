#include "optics/filter_error.hpp"

#include "core/units.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace vkfv::optics {

namespace {

using Complex = std::complex<double>;

constexpr int half = 40;       // points of a lattice across half the pupil
constexpr int frequencies = 7; // parts of the cutoff, and one more would be it
constexpr int directions = 16; // over half a turn; the opposite ones are the conjugates
constexpr int half_heights = 4;
constexpr std::size_t heights = 2 * half_heights + 1;
constexpr double depths_of_field = 2;
constexpr int most_wavelengths = 3; // of a continuous spectrum
constexpr int fewest_cells = 8;
constexpr int most_cells = 16;

Complex product(Complex a, Complex b) {
    return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

// Of each height.
using AtHeights = std::array<Complex, heights>;

double height_of(std::size_t h, double reach) {
    return reach * (static_cast<double>(h) / half_heights - 1);
}

// One wavelength's pupil on a lattice about the chief ray, whose points p + lambda f / 2 are points again for the
// frequencies 2 unit (dx, dy), at heights within `reach` (mm).
class PupilLattice {
  public:
    PupilLattice(const Wavefront& wavefront, const physics::f64::PupilCells& cells, double unit, double reach)
        : half_(static_cast<int>(std::ceil(wavefront.largest_rim() / (wavefront.wavelength() * unit)))),
          side_(2 * half_), unit_(unit), cell_(static_cast<std::size_t>(side_ * side_), -1), wave_(cell_.size()),
          displacement_(cell_.size()), spread_(cell_.size()) {
        const double wave_number = 2 * pi / wavefront.wavelength();
        const Wavefront raised = wavefront.at_height(wavefront.height() + 1);
        const glm::dvec2 chief_slope =
            wavefront.chief_slope() - physics::f64::chief_slope(cells, wavefront.detector_point());
        for (int j = -half_; j < half_; ++j) {
            for (int i = -half_; i < half_; ++i) {
                const glm::dvec2 p = wavefront.chief() + wavefront.wavelength() * unit * glm::dvec2(i + 0.5, j + 0.5);
                if (wavefront.passes(p)) {
                    const std::size_t place = index(i, j);
                    cell_[place] =
                        static_cast<int>(physics::f64::pupil_cell(cells, wavefront.image_slope(p) + chief_slope));
                    const double path = wavefront.path(p);
                    const double defocus = raised.path(p) - path;
                    for (std::size_t h = 0; h < heights; ++h) {
                        wave_[place][h] = std::polar(1.0, wave_number * (path + height_of(h, reach) * defocus));
                    }
                    const glm::dvec2 displacement = wavefront.displacement(p);
                    spread_[place] = (raised.displacement(p) - displacement) * (reach / half_heights);
                    displacement_[place] = displacement - static_cast<double>(half_heights) * spread_[place];
                    ++points_;
                }
            }
        }
    }

    // Hopkins' transfer function.
    AtHeights waves(int dx, int dy) const {
        AtHeights sum{};
        const int reach_x = half_ - std::abs(dx);
        const int reach_y = half_ - std::abs(dy);
        const std::ptrdiff_t step = static_cast<std::ptrdiff_t>(dy) * side_ + dx;
        for (int j = -reach_y; j < reach_y; ++j) {
            for (int i = -reach_x; i < reach_x; ++i) {
                const auto here = static_cast<std::ptrdiff_t>(index(i, j));
                const auto ahead = static_cast<std::size_t>(here + step);
                const auto behind = static_cast<std::size_t>(here - step);
                if (cell_[ahead] >= 0 && cell_[behind] >= 0) {
                    for (std::size_t h = 0; h < heights; ++h) {
                        sum[h] += product(std::conj(wave_[ahead][h]), wave_[behind][h]);
                    }
                }
            }
        }
        return mean(sum);
    }

    // The cells' images as rays make them, each by its filter.
    AtHeights filtered(int dx, int dy, const std::vector<Complex>& of_cell) const {
        const glm::dvec2 turn = -4 * pi * unit_ * glm::dvec2(dx, dy);
        AtHeights sum{};
        for (std::size_t place = 0; place < cell_.size(); ++place) {
            if (cell_[place] >= 0) {
                Complex value = product(of_cell[static_cast<std::size_t>(cell_[place])],
                                        std::polar(1.0, glm::dot(turn, displacement_[place])));
                const Complex step = std::polar(1.0, glm::dot(turn, spread_[place]));
                for (Complex& each : sum) {
                    each += value;
                    value = product(value, step);
                }
            }
        }
        return mean(sum);
    }

  private:
    std::size_t index(int i, int j) const { return static_cast<std::size_t>((j + half_) * side_ + i + half_); }
    AtHeights mean(AtHeights sum) const {
        for (Complex& each : sum) {
            each /= static_cast<double>(points_);
        }
        return sum;
    }

    int half_;
    int side_;
    double unit_;
    int points_ = 0;
    std::vector<int> cell_; // -1: outside the pupil
    std::vector<AtHeights> wave_;
    std::vector<glm::dvec2> displacement_; // at the lowest height
    std::vector<glm::dvec2> spread_;       // of it from one height to the next
};

} // namespace

FilterError largest_filter_error(const PupilFilter& filter, const PointWaves& point, double reach) {
    FilterError largest;
    if (std::ranges::any_of(point.wavefronts(), [](const Wavefront& each) { return each.largest_rim() == 0; })) {
        return largest;
    }
    const double unit = 0.5 * filter.cutoff() / half;
    std::vector<PupilLattice> lattices;
    std::vector<std::array<glm::dvec2, heights>> aside(point.wavefronts().size());
    for (const Wavefront& wavefront : point.wavefronts()) {
        lattices.emplace_back(wavefront, filter.cells(), unit, reach);
    }
    for (std::size_t h = 0; h < heights; ++h) {
        const PointWaves raised = point.at_height(height_of(h, reach));
        for (std::size_t k = 0; k < lattices.size(); ++k) {
            aside[k][h] = raised.aside(raised.wavefronts()[k]);
        }
    }
    std::vector<Complex> of_cell(static_cast<std::size_t>(filter.cell_count()));
    for (int direction = 0; direction < directions; ++direction) {
        for (int s = 1; s <= frequencies; ++s) {
            const glm::dvec2 steps = half * s / (frequencies + 1.0) * direction_of(pi * direction / directions);
            const int dx = static_cast<int>(std::lround(steps.x));
            const int dy = static_cast<int>(std::lround(steps.y));
            const glm::dvec2 frequency = 2 * unit * glm::dvec2(dx, dy);
            for (int cell = 0; cell < filter.cell_count(); ++cell) {
                of_cell[static_cast<std::size_t>(cell)] = filter.transfer(cell, frequency.x, frequency.y);
            }
            AtHeights waves{};
            AtHeights filtered{};
            for (std::size_t k = 0; k < lattices.size(); ++k) {
                const AtHeights of_waves = lattices[k].waves(dx, dy);
                const AtHeights of_filter = lattices[k].filtered(dx, dy, of_cell);
                for (std::size_t h = 0; h < heights; ++h) {
                    const Complex shift =
                        std::polar(point.wavefronts()[k].weight(), -2 * pi * glm::dot(frequency, aside[k][h]));
                    waves[h] += shift * of_waves[h];
                    filtered[h] += shift * of_filter[h];
                }
            }
            for (std::size_t h = 0; h < heights; ++h) {
                if (const double difference = std::abs(filtered[h] - waves[h]); difference > largest.difference) {
                    largest = {.difference = difference,
                               .frequency = frequency,
                               .height = height_of(h, reach),
                               .waves = waves[h],
                               .filtered = filtered[h]};
                }
            }
        }
    }
    return largest;
}

FilterError largest_filter_error(const PupilFilter& filter, const Instrument& instrument, glm::dvec2 field) {
    return largest_filter_error(filter, PointWaves(instrument, field, most_wavelengths),
                                depths_of_field * instrument.first_order.depth_of_field);
}

PupilFilter filter_for_waves(const Instrument& instrument) {
    for (int cells = fewest_cells;; cells += 2) {
        PupilFilter filter = PupilFilter::unparted(instrument, cells);
        if (cells == most_cells ||
            largest_filter_error(filter, instrument, glm::dvec2(0)).difference <= most_error_of_cells) {
            return filter;
        }
    }
}

} // namespace vkfv::optics
