#include "optics/pupil_filter.hpp"

#include "core/error.hpp"
#include "core/units.hpp"
#include "optics/apertures.hpp"
#include "optics/filter_error.hpp"
#include "optics/image_quality.hpp"
#include "optics/wavefront.hpp"

#include <algorithm>
#include <cmath>
#include <thread>
#include <tuple>

namespace vkfv::optics {

namespace {

using Complex = std::complex<double>;

// Points of a lattice across the pupil's half width that the mean over a cell is taken from, for each cell across it.
constexpr int points_a_cell = 10;
constexpr int most_wavelengths = 7; // of a continuous spectrum, whose mean changes slowly with its wavelengths

// Without the care of std::complex for what is not finite.
Complex product(Complex a, Complex b) {
    return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

// The pupil on a lattice whose points p + lambda f / 2 are points again, for frequencies that are multiples of the
// cutoff over `half`. No point lies on an axis, where mirror images would share a cell's edge.
struct Lattice {
    Lattice(const Wavefront& wavefront, int half, const physics::f64::PupilCells& cells)
        : half(half), side(2 * half), spacing(wavefront.largest_rim() / half),
          cell(static_cast<std::size_t>(side * side), -1), wave(cell.size()), tilt(cell.size()) {
        const double k = 2 * pi / wavefront.wavelength();
        for (int j = -half; j < half; ++j) {
            for (int i = -half; i < half; ++i) {
                const glm::dvec2 p = spacing * glm::dvec2(i + 0.5, j + 0.5);
                if (wavefront.passes(p)) {
                    const std::size_t place = index(i, j);
                    cell[place] = static_cast<int>(physics::f64::pupil_cell(cells, wavefront.image_slope(p)));
                    wave[place] = std::polar(1.0, k * wavefront.path(p));
                    tilt[place] = 2 * k * spacing * wavefront.displacement(p);
                }
            }
        }
    }
    std::size_t index(int i, int j) const { return static_cast<std::size_t>((j + half) * side + i + half); }

    // What rays make of each point for a row of frequencies, one after the other.
    class Rays {
      public:
        Rays(const Lattice& lattice, int dx, int dy) : values_(lattice.tilt.size()), steps_(values_.size()) {
            for (std::size_t place = 0; place < values_.size(); ++place) {
                const glm::dvec2 tilt = lattice.tilt[place];
                values_[place] = std::polar(1.0, -dx * tilt.x - dy * tilt.y);
                steps_[place] = std::polar(1.0, -tilt.x);
            }
        }
        void advance() { std::ranges::transform(values_, steps_, values_.begin(), product); }
        const Complex& operator[](std::size_t place) const { return values_[place]; }

      private:
        std::vector<Complex> values_;
        std::vector<Complex> steps_;
    };

    // What waves and what rays make of each cell, summed over its points, for the frequency (dx, dy) cutoff / half.
    struct Sums {
        Complex waves = 0;
        Complex rays = 0;
    };
    void add_up(int dx, int dy, const Rays& rays, std::vector<Sums>& sums) const {
        std::fill(sums.begin(), sums.end(), Sums());
        for (std::size_t place = 0; place < cell.size(); ++place) {
            if (cell[place] >= 0) {
                sums[static_cast<std::size_t>(cell[place])].rays += rays[place];
            }
        }
        const int reach_x = half - std::abs(dx);
        const int reach_y = half - std::abs(dy);
        const std::ptrdiff_t step = static_cast<std::ptrdiff_t>(dy) * side + dx;
        for (int j = -reach_y; j < reach_y; ++j) {
            for (int i = -reach_x; i < reach_x; ++i) {
                const auto place = static_cast<std::ptrdiff_t>(index(i, j));
                const auto here = static_cast<std::size_t>(place);
                const auto ahead = static_cast<std::size_t>(place + step);
                const auto behind = static_cast<std::size_t>(place - step);
                if (cell[here] >= 0 && cell[ahead] >= 0 && cell[behind] >= 0) {
                    sums[static_cast<std::size_t>(cell[here])].waves += product(std::conj(wave[ahead]), wave[behind]);
                }
            }
        }
    }

    int half;
    int side;
    double spacing;
    std::vector<int> cell; // -1: outside the pupil
    std::vector<Complex> wave;
    std::vector<glm::dvec2> tilt;
};

// Values at -steps ... steps and 0 ... steps, bilinear between; 0 beyond.
template <class Value>
Complex interpolated(const Value* values, int steps, double x, double y) {
    if (y < 0 || (y == 0 && x < 0)) {
        return std::conj(interpolated(values, steps, -x, -y));
    }
    if (std::abs(x) >= steps || y >= steps) {
        return 0;
    }
    const double left = std::floor(x);
    const double low = std::floor(y);
    const double u = x - left;
    const double v = y - low;
    const Value* corner = values + static_cast<std::ptrdiff_t>(low) * (2 * steps + 1) + static_cast<int>(left) + steps;
    const auto row = [&](const Value* first) { return Complex(first[0]) * (1 - u) + Complex(first[1]) * u; };
    return row(corner) * (1 - v) + row(corner + 2 * steps + 1) * v;
}

// How the chief ray's slope at the detector grows with its position there, 1/mm: from the axis to the field's edge.
double chief_slope_per_position(const Instrument& instrument) {
    const Imaging imaging = imaging_of(instrument);
    const auto land = [&](glm::dvec2 field) {
        return imaging.trace(field, instrument.first_order.best_focus_offset, imaging.chief_cosines(field), 0);
    };
    const auto axis = land(glm::dvec2(0));
    const auto edge = land(glm::dvec2(instrument.first_order.field_edge, 0));
    const double apart = axis && edge ? edge->position.x - axis->position.x : 0;
    return apart != 0 ? (edge->direction.x / edge->direction.z - axis->direction.x / axis->direction.z) / apart : 0;
}

// What turns the rays' into the waves', as far as it does not amplify.
Complex ratio_of(const Lattice::Sums& sums) {
    const double waves = std::abs(sums.waves);
    const double rays = std::abs(sums.rays);
    return waves == 0 ? 0 : std::polar(waves < rays ? waves / rays : 1.0, std::arg(sums.waves * std::conj(sums.rays)));
}

double shortest_wavelength(std::span<const SpectralNode> nodes) {
    const auto least = std::ranges::min_element(nodes, {}, &SpectralNode::wavelength_um);
    return least->wavelength_um / um_per_mm;
}

} // namespace

int parts_for_waves(const Instrument& instrument) {
    const double pitch =
        shortest_wavelength(spectral_nodes(instrument)) / (4 * instrument.first_order.numerical_aperture);
    return std::max(1, static_cast<int>(std::ceil(instrument.first_order.pixel_pitch / pitch * (1 - 1e-9))));
}

int parts_of(const WaveOptions& options, const Instrument& instrument) {
    return options.parts > 0 ? options.parts : parts_for_waves(instrument);
}

int cells_of(const WaveOptions& options, const Instrument& instrument) {
    return options.cells > 0 ? options.cells : static_cast<int>(filter_for_waves(instrument).cells().side);
}

PupilFilter::PupilFilter(const Instrument& instrument, const WaveOptions& options)
    : PupilFilter(options.cells > 0 ? unparted(instrument, options.cells) : filter_for_waves(instrument)) {
    cells_.parts = static_cast<std::uint32_t>(parts_of(options, instrument));
    part_pitch_ = instrument.first_order.pixel_pitch / cells_.parts;
    noise_ = noise_of_pixels();
}

PupilFilter PupilFilter::unparted(const Instrument& instrument, int cells) {
    PupilFilter filter;
    filter.steps_ = std::max(32, points_a_cell * cells / 2);
    filter.cells_.side = static_cast<std::uint32_t>(cells);
    filter.cells_.parts = 1;
    filter.cells_.sensitive_side = std::sqrt(instrument.fill_factor);
    filter.part_pitch_ = instrument.first_order.pixel_pitch;
    filter.cells_.chief_position = chief_slope_per_position(instrument);
    std::vector<Wavefront> wavefronts;
    double largest = 0;
    double weight = 0;
    glm::dvec2 chief(0);
    for (const SpectralNode& node : at_most(most_wavelengths, spectral_nodes(instrument))) {
        const Wavefront& wavefront = wavefronts.emplace_back(instrument, node);
        weight += node.weight;
        chief += node.weight * wavefront.chief_slope();
        filter.cutoff_ = std::max(filter.cutoff_, 2 * wavefront.largest_rim() / wavefront.wavelength());
        constexpr int azimuths = 64;
        for (int k = 0; k < azimuths; ++k) {
            const double azimuth = 2 * pi * k / azimuths;
            const glm::dvec2 rim = wavefront.rim(azimuth) * glm::dvec2(std::cos(azimuth), std::sin(azimuth));
            largest = std::max(largest, glm::length(wavefront.image_slope(rim)));
        }
    }
    if (largest == 0) {
        throw InputError({.where = {},
                          .key = "diffraction.model",
                          .found = "no light from the axis that comes through the imaging train",
                          .expected = "a pupil",
                          .remedy = "See by vkfv layout what stops the light, or set diffraction.model = \"none\"."});
    }
    filter.cells_.per_slope = 1 / largest;
    filter.cells_.chief_x = chief.x / weight;
    filter.cells_.chief_y = chief.y / weight;
    filter.shares_.resize(static_cast<std::size_t>(filter.cell_count()));
    filter.table_.resize(filter.shares_.size() *
                         static_cast<std::size_t>((2 * filter.steps_ + 1) * (filter.steps_ + 1)));
    for (const Wavefront& wavefront : wavefronts) {
        filter.add_wavelength(wavefront);
    }
    filter.fill_dark_cells();
    return filter;
}

void PupilFilter::fill_dark_cells() {
    const int side = static_cast<int>(cells_.side);
    // From the pupil's middle, in cells.
    const auto middle = [side](int cell) { return glm::dvec2(cell % side, cell / side) - 0.5 * (side - 1); };
    // Of cells that are equally near, the one nearer to an axis: mirror images have mirror images.
    const auto order = [&](int lit, int dark) {
        return std::tuple(glm::length(middle(lit) - middle(dark)), std::abs(middle(lit).y), std::abs(middle(lit).x));
    };
    const auto plane = static_cast<std::ptrdiff_t>(table_.size() / shares_.size());
    for (int dark = 0; dark < cell_count(); ++dark) {
        int nearest = -1;
        for (int lit = 0; lit < cell_count() && share(dark) == 0; ++lit) {
            if (share(lit) > 0 && (nearest < 0 || order(lit, dark) < order(nearest, dark))) {
                nearest = lit;
            }
        }
        if (nearest >= 0) {
            std::copy_n(table_.begin() + nearest * plane, plane, table_.begin() + dark * plane);
        }
    }
}

void PupilFilter::add_wavelength(const Wavefront& wavefront) {
    const Lattice lattice(wavefront, steps_, cells_);
    const std::size_t count = shares_.size();
    std::vector<double> points(count);
    for (const int cell : lattice.cell) {
        if (cell >= 0) {
            points[static_cast<std::size_t>(cell)] += 1;
        }
    }
    const int columns = 2 * steps_ + 1;
    const auto plane = static_cast<std::size_t>(columns * (steps_ + 1));
    std::vector<Complex> own(count * plane); // at multiples of this wavelength's cutoff
    {
        const int workers = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
        std::vector<std::jthread> threads;
        for (int worker = 0; worker < workers; ++worker) {
            threads.emplace_back([&, worker] {
                std::vector<Lattice::Sums> sums(count);
                for (int dy = worker; dy <= steps_; dy += workers) {
                    Lattice::Rays rays(lattice, -steps_, dy);
                    for (int dx = -steps_; dx <= steps_; ++dx, rays.advance()) {
                        lattice.add_up(dx, dy, rays, sums);
                        for (std::size_t cell = 0; cell < count; ++cell) {
                            own[cell * plane + static_cast<std::size_t>(dy * columns + dx + steps_)] =
                                ratio_of(sums[cell]);
                        }
                    }
                }
            });
        }
    }
    double all = 0;
    for (const double each : points) {
        all += each;
    }
    const double ratio = cutoff_ * wavefront.wavelength() / (2 * wavefront.largest_rim());
    for (std::size_t cell = 0; cell < count; ++cell) {
        shares_[cell] += wavefront.weight() * points[cell] / all;
        for (int dy = 0; dy <= steps_; ++dy) {
            for (int dx = -steps_; dx <= steps_; ++dx) {
                const Complex value = interpolated(own.data() + cell * plane, steps_, dx * ratio, dy * ratio);
                table_[cell * plane + static_cast<std::size_t>(dy * columns + dx + steps_)] +=
                    std::complex<float>(wavefront.weight() * value);
            }
        }
    }
}

int PupilFilter::mirrored(int cell) const {
    const int side = static_cast<int>(cells_.side);
    return cell / side * side + side - 1 - cell % side;
}

int PupilFilter::mirrored_upright(int cell) const {
    const int side = static_cast<int>(cells_.side);
    return (side - 1 - cell / side) * side + cell % side;
}

std::complex<double> PupilFilter::transfer(int cell, double fx, double fy) const {
    const auto plane = static_cast<std::size_t>((2 * steps_ + 1) * (steps_ + 1));
    const double scale = steps_ / cutoff_;
    return interpolated(table_.data() + static_cast<std::size_t>(cell) * plane, steps_, fx * scale, fy * scale);
}

double PupilFilter::folded_contrast() const {
    constexpr int samples = 48; // from the axis to the cutoff
    const double sampling = 1 / part_pitch_;
    const double pixel_pitch = part_pitch_ * cells_.parts;
    const auto folded = [sampling](double f) { return f - sampling * std::round(f / sampling); };
    const auto sinc = [](double x) { return x == 0 ? 1.0 : std::sin(pi * x) / (pi * x); };
    double largest = 0;
    for (int j = 0; j < samples; ++j) {
        for (int i = -samples + 1; i < samples; ++i) {
            const double fx = cutoff_ * i / samples;
            const double fy = cutoff_ * j / samples;
            if (folded(fx) == fx && folded(fy) == fy) {
                continue;
            }
            double difference = 0;
            for (int cell = 0; cell < cell_count(); ++cell) {
                difference += share(cell) * std::abs(transfer(cell, folded(fx), folded(fy)) - transfer(cell, fx, fy));
            }
            largest = std::max(largest, difference * std::abs(sinc(fx * pixel_pitch) * sinc(fy * pixel_pitch)));
        }
    }
    return largest;
}

double PupilFilter::noise_of_pixels() const {
    // White noise on the parts of pixels, filtered and added up over what is sensitive; before, over the whole pixel.
    constexpr int samples = 48; // of half the band
    const int parts = static_cast<int>(cells_.parts);
    const auto added_up = [&](double f, bool all) { // cycles per part
        Complex sum = 0;
        for (int part = 0; part < parts; ++part) {
            const double share = all ? 1 : physics::f64::sensitive_share(cells_, static_cast<std::uint32_t>(part));
            sum += std::polar(share, 2 * pi * f * part);
        }
        return std::norm(sum);
    };
    double before = 0;
    double after = 0;
    for (int j = -samples; j < samples; ++j) {
        for (int i = -samples; i < samples; ++i) {
            const double fx = 0.5 * (i + 0.5) / samples;
            const double fy = 0.5 * (j + 0.5) / samples;
            before += added_up(fx, true) * added_up(fy, true);
            const double pixel = added_up(fx, false) * added_up(fy, false);
            for (int cell = 0; cell < cell_count(); ++cell) {
                if (share(cell) > 0) {
                    after += pixel * share(cell) * std::norm(transfer(cell, fx / part_pitch_, fy / part_pitch_));
                }
            }
        }
    }
    return std::sqrt(after / before);
}

} // namespace vkfv::optics
