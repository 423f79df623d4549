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

Complex product(Complex a, Complex b) {
    return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

// One wavelength's pupil on a lattice about the chief ray, whose points p + lambda f / 2 are points again for the
// frequencies 2 unit (dx, dy).
class PupilLattice {
  public:
    PupilLattice(const Wavefront& wavefront, const physics::f64::PupilCells& cells, double unit)
        : half_(static_cast<int>(std::ceil(wavefront.largest_rim() / (wavefront.wavelength() * unit)))),
          side_(2 * half_), unit_(unit), wave_number_(2 * pi / wavefront.wavelength()),
          cell_(static_cast<std::size_t>(side_ * side_), -1), path_(cell_.size()), defocus_(cell_.size()),
          wave_(cell_.size()), displacement_(cell_.size()), spread_(cell_.size()) {
        const Wavefront raised = wavefront.at_height(wavefront.height() + 1);
        const glm::dvec2 chief_slope = wavefront.chief_slope() - cells.chief_position * wavefront.detector_point();
        for (int j = -half_; j < half_; ++j) {
            for (int i = -half_; i < half_; ++i) {
                const glm::dvec2 p = wavefront.chief() + wavefront.wavelength() * unit * glm::dvec2(i + 0.5, j + 0.5);
                if (wavefront.passes(p)) {
                    const std::size_t place = index(i, j);
                    cell_[place] =
                        static_cast<int>(physics::f64::pupil_cell(cells, wavefront.image_slope(p) + chief_slope));
                    path_[place] = wavefront.path(p);
                    defocus_[place] = raised.path(p) - path_[place];
                    displacement_[place] = wavefront.displacement(p);
                    spread_[place] = raised.displacement(p) - displacement_[place];
                    ++points_;
                }
            }
        }
    }

    void raise(double height) {
        height_ = height;
        for (std::size_t place = 0; place < cell_.size(); ++place) {
            wave_[place] = std::polar(1.0, wave_number_ * (path_[place] + height * defocus_[place]));
        }
    }

    // Hopkins' transfer function.
    Complex waves(int dx, int dy) const {
        Complex sum = 0;
        const int reach_x = half_ - std::abs(dx);
        const int reach_y = half_ - std::abs(dy);
        const std::ptrdiff_t step = static_cast<std::ptrdiff_t>(dy) * side_ + dx;
        for (int j = -reach_y; j < reach_y; ++j) {
            for (int i = -reach_x; i < reach_x; ++i) {
                const auto here = static_cast<std::ptrdiff_t>(index(i, j));
                const auto ahead = static_cast<std::size_t>(here + step);
                const auto behind = static_cast<std::size_t>(here - step);
                if (cell_[ahead] >= 0 && cell_[behind] >= 0) {
                    sum += product(std::conj(wave_[ahead]), wave_[behind]);
                }
            }
        }
        return sum / static_cast<double>(points_);
    }

    // The cells' images as rays make them, each by its filter.
    Complex filtered(int dx, int dy, const std::vector<Complex>& of_cell) const {
        const glm::dvec2 turn = -4 * pi * unit_ * glm::dvec2(dx, dy);
        Complex sum = 0;
        for (std::size_t place = 0; place < cell_.size(); ++place) {
            if (cell_[place] >= 0) {
                const glm::dvec2 displacement = displacement_[place] + height_ * spread_[place];
                sum += product(of_cell[static_cast<std::size_t>(cell_[place])],
                               std::polar(1.0, glm::dot(turn, displacement)));
            }
        }
        return sum / static_cast<double>(points_);
    }

  private:
    std::size_t index(int i, int j) const { return static_cast<std::size_t>((j + half_) * side_ + i + half_); }

    int half_;
    int side_;
    double unit_;
    double wave_number_;
    int points_ = 0;
    double height_ = 0;
    std::vector<int> cell_; // -1: outside the pupil
    std::vector<double> path_;
    std::vector<double> defocus_; // of path_ for each mm of height
    std::vector<Complex> wave_;
    std::vector<glm::dvec2> displacement_;
    std::vector<glm::dvec2> spread_; // of displacement_ for each mm of height
};

} // namespace

FilterError largest_filter_error(const PupilFilter& filter, const PointWaves& point, double reach) {
    FilterError largest;
    if (std::ranges::any_of(point.wavefronts(), [](const Wavefront& each) { return each.largest_rim() == 0; })) {
        return largest;
    }
    const double unit = 0.5 * filter.cutoff() / half;
    std::vector<PupilLattice> lattices;
    for (const Wavefront& wavefront : point.wavefronts()) {
        lattices.emplace_back(wavefront, filter.cells(), unit);
    }
    std::vector<Complex> of_cell(static_cast<std::size_t>(filter.cell_count()));
    for (int h = -half_heights; h <= half_heights; ++h) {
        const double height = reach * h / half_heights;
        const PointWaves raised = point.at_height(height);
        std::vector<glm::dvec2> aside;
        for (std::size_t k = 0; k < lattices.size(); ++k) {
            lattices[k].raise(height);
            aside.push_back(raised.aside(raised.wavefronts()[k]));
        }
        for (int direction = 0; direction < directions; ++direction) {
            for (int s = 1; s <= frequencies; ++s) {
                const glm::dvec2 steps = half * s / (frequencies + 1.0) * direction_of(pi * direction / directions);
                const int dx = static_cast<int>(std::lround(steps.x));
                const int dy = static_cast<int>(std::lround(steps.y));
                const glm::dvec2 frequency = 2 * unit * glm::dvec2(dx, dy);
                for (int cell = 0; cell < filter.cell_count(); ++cell) {
                    of_cell[static_cast<std::size_t>(cell)] = filter.transfer(cell, frequency.x, frequency.y);
                }
                Complex waves = 0;
                Complex filtered = 0;
                for (std::size_t k = 0; k < lattices.size(); ++k) {
                    const Complex shift =
                        std::polar(point.wavefronts()[k].weight(), -2 * pi * glm::dot(frequency, aside[k]));
                    waves += shift * lattices[k].waves(dx, dy);
                    filtered += shift * lattices[k].filtered(dx, dy, of_cell);
                }
                if (const double difference = std::abs(filtered - waves); difference > largest.difference) {
                    largest = {.difference = difference,
                               .frequency = frequency,
                               .height = height,
                               .waves = waves,
                               .filtered = filtered};
                }
            }
        }
    }
    return largest;
}

} // namespace vkfv::optics
