#include "optics/waves/filter_error.hpp"

#include "core/mathematics/complex_product.hpp"
#include "core/mathematics/units.hpp"
#include "core/threads/parallel_list.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <future>
#include <optional>
#include <utility>
#include <vector>

namespace vkfv::optics {

namespace {

using Complex = std::complex<double>;

constexpr int half = 40;       // lattice points across half the pupil
constexpr int frequencies = 7; // tested frequencies: multiples of 1 / (frequencies + 1) of the cutoff
constexpr int directions = 16; // over half a turn; opposite directions are conjugates
constexpr int half_heights = 4;
constexpr std::size_t heights = 2 * half_heights + 1;
constexpr double depths_of_field = 2;
constexpr int most_wavelengths_tried = 3; // wavelengths for a continuous spectrum
constexpr int fewest_cells = 8;
constexpr int most_cells = 16;

// A complex value at each height.
using AtHeights = std::array<Complex, heights>;

double height_of(std::size_t h, double reach) {
    return reach * (static_cast<double>(h) / half_heights - 1);
}

// Sums over points, at each height, of a number that rotates by the same angle from one height to the next: v_(h+1) = 2
// cos(angle) v_h - v_(h-1) takes half of the products of v_(h+1) = step v_h. Four sums run in parallel, as a single one
// would wait for each addition.
class HeightSums {
  public:
    // Adds a number by its value at the lowest height and the factor `step` of modulus 1 from one height to the next.
    void add(Complex lowest, Complex step) {
        const Complex second = product(lowest, step);
        real_[next_] = lowest.real();
        imaginary_[next_] = lowest.imag();
        second_real_[next_] = second.real();
        second_imaginary_[next_] = second.imag();
        twice_cosine_[next_] = 2 * step.real();
        if (++next_ == lanes) {
            add_lanes();
        }
    }

    AtHeights all() {
        while (next_ > 0) {
            add(0, 0);
        }
        AtHeights sums{};
        for (std::size_t h = 0; h < heights; ++h) {
            for (std::size_t k = 0; k < lanes; ++k) {
                sums[h] += Complex(sums_[h].real[k], sums_[h].imaginary[k]);
            }
        }
        return sums;
    }

  private:
    static constexpr std::size_t lanes = 4;
    using Lanes = std::array<double, lanes>;

    void add_lanes() {
        for (std::size_t k = 0; k < lanes; ++k) {
            double before_real = real_[k];
            double before_imaginary = imaginary_[k];
            double real = second_real_[k];
            double imaginary = second_imaginary_[k];
            sums_[0].real[k] += before_real;
            sums_[0].imaginary[k] += before_imaginary;
            for (std::size_t h = 1; h < heights; ++h) {
                sums_[h].real[k] += real;
                sums_[h].imaginary[k] += imaginary;
                const double next_real = twice_cosine_[k] * real - before_real;
                const double next_imaginary = twice_cosine_[k] * imaginary - before_imaginary;
                before_real = real;
                before_imaginary = imaginary;
                real = next_real;
                imaginary = next_imaginary;
            }
        }
        next_ = 0;
    }

    struct Sum {
        Lanes real{};
        Lanes imaginary{};
    };
    std::array<Sum, heights> sums_;
    Lanes real_{}, imaginary_{}, second_real_{}, second_imaginary_{}, twice_cosine_{};
    std::size_t next_ = 0;
};

// The powers of a number of modulus 1, from exponent 0; negative exponents give the conjugates.
class Powers {
  public:
    static constexpr int most = half / (frequencies + 1) + 1; // largest step between tested frequencies

    explicit Powers(double phase) {
        powers_[0] = 1;
        powers_[1] = std::polar(1.0, phase);
        for (std::size_t k = 2; k < powers_.size(); ++k) {
            powers_[k] = product(powers_[k - 1], powers_[1]);
        }
    }
    Complex operator()(int exponent) const {
        const Complex power = powers_[static_cast<std::size_t>(std::abs(exponent))];
        return exponent < 0 ? std::conj(power) : power;
    }

  private:
    std::array<Complex, most + 1> powers_;
};

// A phase factor at the lowest height, and the factor from one height to the next.
struct Phase {
    Complex lowest = 1;
    Complex step = 1;
};

// The pupil of one wavelength on a lattice about the chief ray whose points, shifted by lambda f / 2, are lattice
// points again for the frequencies 2 unit (dx, dy), at heights within `reach` (mm).
class PupilLattice {
  public:
    PupilLattice(const Wavefront& wavefront, const physics::f64::PupilCells& cells, double unit, double reach)
        : half_(static_cast<int>(std::ceil(wavefront.largest_rim() / (wavefront.wavelength() * unit)))),
          side_(2 * half_), passes_(static_cast<std::size_t>(side_ * side_)), wave_(passes_.size()) {
        const glm::dvec2 chief_slope =
            wavefront.chief_slope() - physics::f64::chief_slope(cells, wavefront.detector_point());
        const auto rows = parallel_list(side_, [&](int row) {
            const int j = row - half_;
            std::vector<Point> points;
            for (int i = -half_; i < half_; ++i) {
                const glm::dvec2 p = wavefront.chief() + wavefront.wavelength() * unit * glm::dvec2(i + 0.5, j + 0.5);
                if (wavefront.passes(p)) {
                    passes_[index(i, j)] = 1;
                    wave_[index(i, j)] = wave_of(wavefront, p, reach);
                    const std::uint32_t cell = physics::f64::pupil_cell(cells, wavefront.image_slope(p) + chief_slope);
                    points.push_back(point_of(wavefront, p, cell, unit, reach));
                }
            }
            return points;
        });
        std::size_t count = 0;
        for (const auto& points : rows) {
            count += points.size();
        }
        points_.reserve(count); // without it, growing would touch several times the memory, slower than the computation
        for (const auto& points : rows) {
            points_.insert(points_.end(), points.begin(), points.end());
        }
    }

    // Hopkins' transfer function at each height.
    AtHeights waves(int dx, int dy) const {
        HeightSums sums;
        const int reach_x = half_ - std::abs(dx);
        const int reach_y = half_ - std::abs(dy);
        const std::ptrdiff_t step = static_cast<std::ptrdiff_t>(dy) * side_ + dx;
        for (int j = -reach_y; j < reach_y; ++j) {
            for (int i = -reach_x; i < reach_x; ++i) {
                const auto here = static_cast<std::ptrdiff_t>(index(i, j));
                const auto ahead = static_cast<std::size_t>(here + step);
                const auto behind = static_cast<std::size_t>(here - step);
                if (passes_[ahead] != 0 && passes_[behind] != 0) {
                    sums.add(product(std::conj(wave_[ahead].lowest), wave_[behind].lowest),
                             product(std::conj(wave_[ahead].step), wave_[behind].step));
                }
            }
        }
        return mean(sums.all());
    }

    // exp(-2 pi i f . t) of each point at the lowest height, and its factor from one height to the next. Neighbouring
    // frequencies are reached by products, as sines and cosines took three quarters of the time.
    class Rays {
      public:
        explicit Rays(const PupilLattice& lattice) : lattice_(lattice), phases_(lattice.points_.size()) {}

        void go_to(int dx, int dy) {
            const int x = dx - dx_;
            const int y = dy - dy_;
            for (std::size_t k = 0; k < phases_.size(); ++k) {
                const Point& point = lattice_.points_[k];
                Phase& phase = phases_[k];
                phase.lowest = product(phase.lowest, product(point.lowest[0](x), point.lowest[1](y)));
                phase.step = product(phase.step, product(point.step[0](x), point.step[1](y)));
            }
            dx_ = dx;
            dy_ = dy;
        }

        // The ray-optical images of all cells, each multiplied by its filter's transfer function, at each height.
        AtHeights filtered(const std::vector<Complex>& of_cell) const {
            HeightSums sums;
            for (std::size_t k = 0; k < phases_.size(); ++k) {
                sums.add(product(of_cell[lattice_.points_[k].cell], phases_[k].lowest), phases_[k].step);
            }
            return lattice_.mean(sums.all());
        }

      private:
        const PupilLattice& lattice_;
        int dx_ = 0;
        int dy_ = 0;
        std::vector<Phase> phases_; // one for each point
    };

  private:
    struct Point {
        std::uint32_t cell;
        std::array<Powers, 2> lowest; // powers for a step of frequency along x and along y
        std::array<Powers, 2> step;
    };

    static Phase wave_of(const Wavefront& wavefront, glm::dvec2 p, double reach) {
        const double wave_number = 2 * pi / wavefront.wavelength();
        const double defocus = wavefront.path_of_height(p);
        return {.lowest = std::polar(1.0, wave_number * (wavefront.path(p) + height_of(0, reach) * defocus)),
                .step = std::polar(1.0, wave_number * (reach / half_heights) * defocus)};
    }

    static Point point_of(const Wavefront& wavefront, glm::dvec2 p, std::uint32_t cell, double unit, double reach) {
        const glm::dvec2 spread = wavefront.displacement_of_height(p) * (reach / half_heights);
        const glm::dvec2 lowest = wavefront.displacement(p) - static_cast<double>(half_heights) * spread;
        const double turn = -4 * pi * unit;
        return {.cell = cell,
                .lowest = {Powers(turn * lowest.x), Powers(turn * lowest.y)},
                .step = {Powers(turn * spread.x), Powers(turn * spread.y)}};
    }

    std::size_t index(int i, int j) const { return static_cast<std::size_t>((j + half_) * side_ + i + half_); }
    AtHeights mean(AtHeights sum) const {
        for (Complex& each : sum) {
            each /= static_cast<double>(points_.size());
        }
        return sum;
    }

    int half_;
    int side_;
    std::vector<char> passes_;
    std::vector<Phase> wave_;
    std::vector<Point> points_; // points that pass
};

// The number of directions that are not mirror images of others: on the axis of a symmetric instrument one in eight, at
// a point of its x axis one in two. Opposite directions are conjugates and not counted.
int directions_of(const PointWaves& point) {
    const auto& wavefronts = point.wavefronts();
    return std::ranges::all_of(wavefronts, &Wavefront::round)      ? directions / 4 + 1
           : std::ranges::all_of(wavefronts, &Wavefront::mirrored) ? directions / 2 + 1
                                                                   : directions;
}

} // namespace

FilterError largest_filter_error(const PupilFilter& filter, const PointWaves& point, double reach) {
    const auto& wavefronts = point.wavefronts();
    if (std::ranges::any_of(wavefronts, [](const Wavefront& each) { return each.largest_rim() == 0; })) {
        return {};
    }
    const double unit = 0.5 * filter.cutoff() / half;
    std::vector<PupilLattice> lattices;
    std::vector<std::array<glm::dvec2, heights>> aside(wavefronts.size());
    for (const Wavefront& wavefront : wavefronts) {
        lattices.emplace_back(wavefront, filter.cells(), unit, reach);
    }
    for (std::size_t h = 0; h < heights; ++h) {
        const PointWaves raised = point.at_height(height_of(h, reach));
        for (std::size_t k = 0; k < lattices.size(); ++k) {
            aside[k][h] = raised.aside(raised.wavefronts()[k]);
        }
    }
    const auto largest_along = [&](int direction) {
        FilterError worst;
        std::vector<PupilLattice::Rays> rays(lattices.begin(), lattices.end());
        for (int s = 1; s <= frequencies; ++s) {
            const glm::dvec2 steps = half * s / (frequencies + 1.0) * direction_of(pi * direction / directions);
            const int dx = static_cast<int>(std::lround(steps.x));
            const int dy = static_cast<int>(std::lround(steps.y));
            const glm::dvec2 frequency = 2 * unit * glm::dvec2(dx, dy);
            const auto of_cell = filter.transfers(wavefronts.front().detector_point(), frequency.x, frequency.y);
            AtHeights waves{};
            AtHeights filtered{};
            for (std::size_t k = 0; k < lattices.size(); ++k) {
                rays[k].go_to(dx, dy);
                const AtHeights of_waves = lattices[k].waves(dx, dy);
                const AtHeights of_filter = rays[k].filtered(of_cell);
                for (std::size_t h = 0; h < heights; ++h) {
                    const Complex shift =
                        std::polar(wavefronts[k].weight(), -2 * pi * glm::dot(frequency, aside[k][h]));
                    waves[h] += shift * of_waves[h];
                    filtered[h] += shift * of_filter[h];
                }
            }
            for (std::size_t h = 0; h < heights; ++h) {
                if (const double difference = std::abs(filtered[h] - waves[h]); difference > worst.difference) {
                    worst = {.difference = difference,
                             .frequency = frequency,
                             .height = height_of(h, reach),
                             .waves = waves[h],
                             .filtered = filtered[h]};
                }
            }
        }
        return worst;
    };
    const std::vector<FilterError> largest = parallel_list(directions_of(point), largest_along);
    return *std::ranges::max_element(largest, {}, &FilterError::difference);
}

glm::dvec2 edge_of(const Instrument& instrument) {
    return {instrument.first_order.field_edge, 0};
}

FilterError largest_filter_error(const PupilFilter& filter, const Instrument& instrument, glm::dvec2 field) {
    const auto& known = filter.known_errors();
    if (field == glm::dvec2(0) && known.axis) {
        return *known.axis;
    }
    if (field == edge_of(instrument) && known.edge) {
        return *known.edge;
    }
    if (field == instrument.first_order.field_corner && known.corner) {
        return *known.corner;
    }
    return largest_filter_error(filter, point_for_filter(instrument, field), reach_of_filter(instrument));
}

double reach_of_filter(const Instrument& instrument) {
    return depths_of_field * instrument.first_order.depth_of_field;
}

PointWaves point_for_filter(const Instrument& instrument, glm::dvec2 field) {
    return PointWaves(instrument, field, most_wavelengths_tried);
}

namespace {

// Searches the cheapest sufficient filter of an instrument, by its contrast errors.
class FilterSearch {
  public:
    explicit FilterSearch(const Instrument& instrument)
        : instrument_(instrument), reach_(reach_of_filter(instrument)), wavefronts_(wavefronts_for_cells(instrument)) {}

    // The filter with the fewest cells, at least `fewest`, whose error on the axis is at most `most_error`; with
    // most_cells if none is.
    PupilFilter with_cells(int fewest, double most_error) {
        for (int cells = fewest;; cells += 2) {
            PupilFilter filter = PupilFilter::unparted(instrument_, wavefronts_, cells);
            filter.set_known_errors({.axis = error_on_axis(filter), .edge = {}, .corner = {}});
            if (cells >= most_cells || filter.known_errors().axis->difference <= most_error) {
                return filter;
            }
        }
    }
    PupilFilter with_given_cells(int cells) const { return PupilFilter::unparted(instrument_, wavefronts_, cells); }

    // True if the errors at the edge and in the corner are at most `most_error`; they are stored in the filter.
    bool is_good(PupilFilter& filter, double most_error) {
        know({edge_of(instrument_), instrument_.first_order.field_corner});
        auto errors = filter.known_errors();
        errors.edge = error_at(filter, edge_of(instrument_));
        errors.corner = error_at(filter, instrument_.first_order.field_corner);
        filter.set_known_errors(errors);
        return std::max(errors.edge->difference, errors.corner->difference) <= most_error;
    }

    // True if the axis' filter suffices for the whole field. Tiles cannot reduce the error that few cells leave on the
    // axis.
    bool is_enough(PupilFilter& filter) {
        constexpr double more_than_on_axis = 1.5;
        auto errors = filter.known_errors();
        errors.axis = errors.axis ? errors.axis : error_on_axis(filter);
        filter.set_known_errors(errors);
        return is_good(filter, std::max(most_error_of_axis, more_than_on_axis * errors.axis->difference));
    }

    struct Tiled {
        PupilFilter filter;
        double worst; // largest error on the axis, at the edge, in the corner and between tiles
    };
    Tiled with_tiles(const PupilFilter& axis, int tiles) {
        PupilFilter filter = axis.tiled(instrument_, tiles);
        is_good(filter, most_error_of_tiles);
        auto errors = filter.known_errors();
        errors.axis = error_on_axis(filter);
        filter.set_known_errors(errors);
        double worst = std::max({errors.axis->difference, errors.edge->difference, errors.corner->difference});
        const auto between = between_tiles(tiles);
        know(between);
        for (const glm::dvec2 field : between) {
            worst = std::max(worst, error_at(filter, field).difference);
        }
        return {.filter = std::move(filter), .worst = worst};
    }

    // The fewest tiles of sufficiently small error; fewer still if the next number hardly reduces it.
    Tiled with_fewest_tiles(const PupilFilter& axis) {
        constexpr int most_tiles = 9;
        Tiled best = with_tiles(axis, 3);
        for (int tiles = 5; tiles <= most_tiles && best.worst > most_error_of_tiles; tiles += 2) {
            Tiled next = with_tiles(axis, tiles);
            if (next.worst > hardly_less * best.worst) {
                break;
            }
            best = std::move(next);
        }
        return best;
    }

    // Adds cells at the same number of tiles, while the error is too large and more cells reduce it.
    Tiled with_more_cells(Tiled best) {
        const int tiles = best.filter.tiles().across();
        for (int cells = static_cast<int>(best.filter.cells().side) + 2;
             cells <= most_cells && best.worst > most_error_of_tiles; cells += 2) {
            Tiled next = with_tiles(with_given_cells(cells), tiles);
            if (next.worst > hardly_less * best.worst) {
                break;
            }
            best = std::move(next);
        }
        return best;
    }

  private:
    static constexpr double hardly_less = 0.95;

    FilterError error_on_axis(const PupilFilter& filter) {
        if (!axis_) {
            axis_ = wavefronts_.size() == 1 ? PointWaves(wavefronts_) : point_for_filter(instrument_, glm::dvec2(0));
        }
        return largest_filter_error(filter, *axis_, reach_);
    }
    // Traces the wavefronts of these points in parallel, unless they are known.
    void know(const std::vector<glm::dvec2>& fields) {
        std::vector<std::future<Point>> traced;
        for (const glm::dvec2 field : fields) {
            if (std::ranges::find(points_, field, &Point::field) == points_.end()) {
                traced.push_back(std::async(std::launch::async, [this, field] {
                    return Point{.field = field, .waves = point_for_filter(instrument_, field)};
                }));
            }
        }
        for (auto& point : traced) {
            points_.push_back(point.get());
        }
    }
    FilterError error_at(const PupilFilter& filter, glm::dvec2 field) const {
        return largest_filter_error(filter, std::ranges::find(points_, field, &Point::field)->waves, reach_);
    }

    // Field points midway between four tiles, in the corners and at the edges of the field; the quarters of a symmetric
    // train are equivalent.
    std::vector<glm::dvec2> between_tiles(int tiles) const {
        const glm::dvec2 half = instrument_.first_order.field_corner;
        const double outer = 1 - 1.0 / (tiles - 1); // in units of the half field
        const double inner = 1.0 / (tiles - 1);     // nearest to the axis
        std::vector<glm::dvec2> points = {half * outer, half * glm::dvec2(outer, inner)};
        if (imaging_of(instrument_).symmetric) {
            if (half.x != half.y) {
                points.push_back(half * glm::dvec2(inner, outer));
            }
            return points;
        }
        for (const auto& [x, y] : {std::pair{-outer, outer},
                                   {-outer, -outer},
                                   {outer, -outer},
                                   {-outer, inner},
                                   {inner, outer},
                                   {inner, -outer}}) {
            points.push_back(half * glm::dvec2(x, y));
        }
        return points;
    }

    struct Point {
        glm::dvec2 field;
        PointWaves waves;
    };

    const Instrument& instrument_;
    double reach_;
    std::vector<Wavefront> wavefronts_;
    std::optional<PointWaves> axis_;
    std::vector<Point> points_;
};

} // namespace

PupilFilter filter_for_waves(const Instrument& instrument, const WaveOptions& options) {
    constexpr double share_of_cells = 0.8; // cells may use this share of the error allowed with tiles
    FilterSearch search(instrument);
    PupilFilter filter = options.cells > 0 ? search.with_given_cells(options.cells)
                                           : search.with_cells(fewest_cells, most_error_of_cells);
    if (options.tiles == 1 || (options.tiles == 0 && search.is_enough(filter))) {
        return filter;
    }
    if (options.cells == 0) {
        filter = search.with_cells(static_cast<int>(filter.cells().side), share_of_cells * most_error_of_tiles);
    }
    if (options.tiles > 0) {
        return filter.tiled(instrument, options.tiles);
    }
    auto tiled = search.with_fewest_tiles(filter);
    return options.cells > 0 ? tiled.filter : search.with_more_cells(std::move(tiled)).filter;
}

} // namespace vkfv::optics
