#include "optics/waves/cell_transfer.hpp"

#include "core/mathematics/complex_product.hpp"
#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"
#include "core/threads/parallel_rows.hpp"
#include "optics/instrument/image_quality.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <tuple>

namespace vkfv::optics {

namespace {

using Complex = std::complex<double>;

// The number of lattice points across a cell, over which the cell's mean is taken.
constexpr int points_a_cell = 10;
constexpr int fewest_steps = 32;
constexpr int most_wavelengths = 7; // enough for the slowly varying mean of a continuous spectrum

// Sums over the points of a cell of the wave-optical and the ray-optical transfer.
struct Sums {
    Complex waves = 0;
    Complex rays = 0;
};

// The factor that turns the ray-optical transfer into the wave-optical one, limited to the modulus 1 so that it does
// not amplify noise.
Complex ratio_of(const Sums& sums) {
    const double waves = std::abs(sums.waves);
    const double rays = std::abs(sums.rays);
    return waves == 0 ? 0 : std::polar(waves < rays ? waves / rays : 1.0, std::arg(sums.waves * std::conj(sums.rays)));
}

// Evaluates interpolated() for all cells, from the nodes that node(column, row) returns. Nodes whose weight is rounding
// only are not computed.
template <class Node>
std::vector<Complex> interpolated_cells(std::size_t cells, int steps, double x, double y, const Node& node) {
    constexpr double rounding = 1e-9; // in units of the nodes' distance
    std::vector<Complex> result(cells);
    if (y < 0 || (y == 0 && x < 0)) {
        result = interpolated_cells(cells, steps, -x, -y, node);
        std::ranges::transform(result, result.begin(), [](Complex value) { return std::conj(value); });
        return result;
    }
    if (std::abs(x) >= steps || y >= steps) {
        return result;
    }
    const auto snapped = [](double value) {
        return std::abs(value - std::round(value)) < rounding ? std::round(value) : value;
    };
    const double left = std::floor(snapped(x));
    const double low = std::floor(snapped(y));
    const double u = snapped(x) - left;
    const double v = snapped(y) - low;
    const auto add = [&](int column, int row, double weight) {
        if (weight > 0) {
            const auto& values = node(static_cast<int>(left) + column, static_cast<int>(low) + row);
            for (std::size_t cell = 0; cell < cells; ++cell) {
                result[cell] += weight * values[cell];
            }
        }
    };
    add(0, 0, (1 - u) * (1 - v));
    add(1, 0, u * (1 - v));
    add(0, 1, (1 - u) * v);
    add(1, 1, u * v);
    return result;
}

// The chief ray's slope at the detector per position there (1/mm), between the axis and the field's edge.
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

} // namespace

// The pupil of one wavelength on a lattice whose points, shifted by lambda f / 2, are lattice points again for
// frequencies f that are multiples of the cutoff over `half`. No point lies on an axis, where mirror images would share
// a cell's edge.
struct CellTransfer::Lattice {
    // middle: the p at the lattice's centre; slope: that of its chief ray at the detector, minus that of the chief ray
    // relative to which light is sorted into cells.
    Lattice(const Wavefront& wavefront, int half, const physics::f64::PupilCells& cells, glm::dvec2 middle,
            glm::dvec2 slope)
        : half(half), side(2 * half), spacing(wavefront.largest_rim() / half),
          cell(static_cast<std::size_t>(side * side), -1), wave(cell.size()), tilt(cell.size()) {
        const double k = 2 * pi / wavefront.wavelength();
        for (int j = -half; j < half; ++j) {
            for (int i = -half; i < half; ++i) {
                const glm::dvec2 p = middle + spacing * glm::dvec2(i + 0.5, j + 0.5);
                if (wavefront.passes(p)) {
                    const std::size_t place = index(i, j);
                    cell[place] = static_cast<int>(physics::f64::pupil_cell(cells, wavefront.image_slope(p) + slope));
                    wave[place] = std::polar(1.0, k * wavefront.path(p));
                    tilt[place] = 2 * k * spacing * wavefront.displacement(p);
                }
            }
        }
    }
    std::size_t index(int i, int j) const { return static_cast<std::size_t>((j + half) * side + i + half); }

    // The ray-optical transfer of each point for a row of frequencies, advanced from one to the next.
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

    // Sums both transfers over each cell for the frequency (dx, dy) cutoff / half.
    template <class RaysOfPlaces>
    void add_up(int dx, int dy, const RaysOfPlaces& rays, std::vector<Sums>& sums) const {
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

    // The ray-optical transfer of each point for a single frequency.
    struct RaysThere {
        const Lattice& lattice;
        int dx;
        int dy;
        Complex operator[](std::size_t place) const {
            return std::polar(1.0, -dx * lattice.tilt[place].x - dy * lattice.tilt[place].y);
        }
    };

    int half;
    int side;
    double spacing;
    std::vector<int> cell; // -1: outside the pupil
    std::vector<Complex> wave;
    std::vector<glm::dvec2> tilt;
};

int table_steps(int cells) {
    return std::max(fewest_steps, points_a_cell * cells / 2);
}

CellTransfer::~CellTransfer() = default;
CellTransfer::CellTransfer(CellTransfer&&) noexcept = default;
CellTransfer& CellTransfer::operator=(CellTransfer&&) noexcept = default;

CellTransfer::CellTransfer(const Instrument& instrument, int cells)
    : CellTransfer(instrument, wavefronts_for_cells(instrument), cells) {}

CellTransfer::CellTransfer(const Instrument& instrument, std::vector<Wavefront> wavefronts, int cells)
    : steps_(table_steps(cells)), wavefronts_(std::move(wavefronts)) {
    cells_.side = static_cast<std::uint32_t>(cells);
    cells_.parts = 1;
    cells_.sensitive_side = std::sqrt(instrument.fill_factor);
    cells_.chief_position = chief_slope_per_position(instrument);
    double largest = 0;
    double weight = 0;
    glm::dvec2 chief(0);
    for (const Wavefront& wavefront : wavefronts_) {
        weight += wavefront.weight();
        chief += wavefront.weight() * wavefront.chief_slope();
        cutoff_ = std::max(cutoff_, 2 * wavefront.largest_rim() / wavefront.wavelength());
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
    cells_.per_slope = 1 / largest;
    cells_.chief_x = chief.x / weight;
    cells_.chief_y = chief.y / weight;
    round_ = std::ranges::all_of(wavefronts_, &Wavefront::round);
    shares_.resize(physics::f64::pupil_cell_count(cells_));
    for (const Wavefront& wavefront : wavefronts_) {
        add_lattice(wavefront, glm::dvec2(0), glm::dvec2(0));
    }
    find_nearest_lit();
}

CellTransfer::CellTransfer(const CellTransfer& axis, std::vector<Wavefront> wavefronts)
    : cells_(axis.cells_), steps_(axis.steps_), cutoff_(axis.cutoff_), wavefronts_(std::move(wavefronts)),
      shares_(axis.shares_.size()) {
    round_ = std::ranges::all_of(wavefronts_, &Wavefront::round);
    for (const Wavefront& wavefront : wavefronts_) {
        add_lattice(wavefront, wavefront.chief(),
                    wavefront.chief_slope() - physics::f64::chief_slope(cells_, wavefront.detector_point()));
    }
    find_nearest_lit();
}

void CellTransfer::add_lattice(const Wavefront& wavefront, glm::dvec2 middle, glm::dvec2 slope) {
    const Lattice& lattice =
        *lattices_.emplace_back(std::make_unique<Lattice>(wavefront, steps_, cells_, middle, slope));
    nodes_.push_back(std::make_unique<Nodes>());
    std::vector<double> points(shares_.size());
    double all = 0;
    for (const int cell : lattice.cell) {
        if (cell >= 0) {
            points[static_cast<std::size_t>(cell)] += 1;
            all += 1;
        }
    }
    for (std::size_t cell = 0; cell < shares_.size(); ++cell) {
        shares_[cell] += wavefront.weight() * points[cell] / all;
    }
}

void CellTransfer::find_nearest_lit() {
    const int side = static_cast<int>(cells_.side);
    const int count = static_cast<int>(shares_.size());
    const auto share = [&](int cell) { return shares_[static_cast<std::size_t>(cell)]; };
    // Distances are in cells from the pupil's middle.
    const auto middle = [side](int cell) { return glm::dvec2(cell % side, cell / side) - 0.5 * (side - 1); };
    // Among equally near cells the order prefers the one nearer to an axis, so that mirror images stay mirror images.
    const auto order = [&](int lit, int dark) {
        return std::tuple(glm::length(middle(lit) - middle(dark)), std::abs(middle(lit).y), std::abs(middle(lit).x));
    };
    for (int cell = 0; cell < count; ++cell) {
        int nearest = cell;
        for (int lit = 0; lit < count && share(cell) == 0; ++lit) {
            if (share(lit) > 0 && (nearest == cell || order(lit, cell) < order(nearest, cell))) {
                nearest = lit;
            }
        }
        nearest_lit_.push_back(static_cast<std::size_t>(nearest));
    }
}

std::vector<std::complex<float>> CellTransfer::table() const {
    const std::size_t count = shares_.size();
    const int columns = 2 * steps_ + 1;
    const auto plane = static_cast<std::size_t>(columns * (steps_ + 1));
    std::vector<std::complex<float>> table(count * plane);
    for (std::size_t wavelength = 0; wavelength < wavefronts_.size(); ++wavelength) {
        const Wavefront& wavefront = wavefronts_[wavelength];
        const Lattice& lattice = *lattices_[wavelength];
        std::vector<Complex> own(count * plane); // at multiples of this wavelength's cutoff
        parallel_bands(steps_ + 1, 1, [&](int first, int end) {
            std::vector<Sums> sums(count);
            for (int dy = first; dy < end; ++dy) {
                Lattice::Rays rays(lattice, -steps_, dy);
                for (int dx = -steps_; dx <= steps_; ++dx, rays.advance()) {
                    lattice.add_up(dx, dy, rays, sums);
                    for (std::size_t cell = 0; cell < count; ++cell) {
                        own[cell * plane + static_cast<std::size_t>(dy * columns + dx + steps_)] = ratio_of(sums[cell]);
                    }
                }
            }
        });
        const double ratio = cutoff_ * wavefront.wavelength() / (2 * wavefront.largest_rim());
        std::vector<TablePlace> places; // places of the table's nodes in `own`
        for (int dy = 0; dy <= steps_; ++dy) {
            for (int dx = -steps_; dx <= steps_; ++dx) {
                places.push_back(table_place(steps_, dx * ratio, dy * ratio));
            }
        }
        parallel_bands(static_cast<int>(count), 1, [&](int first, int end) {
            for (auto cell = static_cast<std::size_t>(first); cell < static_cast<std::size_t>(end); ++cell) {
                for (std::size_t node = 0; node < plane; ++node) {
                    const Complex value = interpolated(own.data() + cell * plane, steps_, places[node]);
                    table[cell * plane + node] += std::complex<float>(wavefront.weight() * value);
                }
            }
        });
    }
    for (std::size_t cell = 0; cell < count; ++cell) {
        if (nearest_lit_[cell] != cell) {
            const auto lit = table.begin() + static_cast<std::ptrdiff_t>(nearest_lit_[cell] * plane);
            std::copy_n(lit, plane, table.begin() + static_cast<std::ptrdiff_t>(cell * plane));
        }
    }
    return table;
}

// For a round pupil only one of eight mirror images of a frequency is computed: a cell's value is that of its mirror
// image at the mirrored frequency.
const CellTransfer::CellValues& CellTransfer::node_of_wavelength(std::size_t wavelength, int dx, int dy) const {
    Nodes& nodes = *nodes_[wavelength];
    {
        const std::scoped_lock lock(nodes.mutex);
        if (const auto found = nodes.values.find({dx, dy}); found != nodes.values.end()) {
            return found->second;
        }
    }
    CellValues values(shares_.size());
    const bool mirrored = round_ && dx < 0;
    const bool swapped = round_ && std::abs(dx) < dy;
    if (mirrored || swapped) {
        const int side = static_cast<int>(cells_.side);
        const int across = mirrored ? -dx : dx;
        const CellValues& image = node_of_wavelength(wavelength, swapped ? dy : across, swapped ? across : dy);
        for (int row = 0; row < side; ++row) {
            for (int column = 0; column < side; ++column) {
                const int from_column = mirrored ? side - 1 - column : column;
                values[static_cast<std::size_t>(row * side + column)] =
                    image[static_cast<std::size_t>(swapped ? from_column * side + row : row * side + from_column)];
            }
        }
    } else {
        const Lattice& lattice = *lattices_[wavelength];
        std::vector<Sums> sums(shares_.size());
        lattice.add_up(dx, dy, Lattice::RaysThere{lattice, dx, dy}, sums);
        std::ranges::transform(sums, values.begin(), ratio_of);
    }
    const std::scoped_lock lock(nodes.mutex);
    return nodes.values.try_emplace({dx, dy}, std::move(values)).first->second;
}

CellTransfer::CellValues CellTransfer::table_node(int dx, int dy) const {
    std::vector<std::complex<float>> sum(shares_.size());
    for (std::size_t wavelength = 0; wavelength < wavefronts_.size(); ++wavelength) {
        const Wavefront& wavefront = wavefronts_[wavelength];
        const double ratio = cutoff_ * wavefront.wavelength() / (2 * wavefront.largest_rim());
        const CellValues values =
            interpolated_cells(shares_.size(), steps_, dx * ratio, dy * ratio,
                               [&](int i, int j) -> const CellValues& { return node_of_wavelength(wavelength, i, j); });
        for (std::size_t cell = 0; cell < sum.size(); ++cell) {
            sum[cell] += std::complex<float>(wavefront.weight() * values[cell]);
        }
    }
    CellValues node(sum.size());
    for (std::size_t cell = 0; cell < sum.size(); ++cell) {
        node[cell] = Complex(sum[nearest_lit_[cell]]);
    }
    return node;
}

std::vector<Complex> CellTransfer::at(double fx, double fy) const {
    const double scale = steps_ / cutoff_;
    return interpolated_cells(shares_.size(), steps_, fx * scale, fy * scale,
                              [&](int dx, int dy) { return table_node(dx, dy); });
}

std::vector<Wavefront> wavefronts_for_cells(const Instrument& instrument, glm::dvec2 field) {
    return wavefronts_of(instrument, at_most(most_wavelengths, spectral_nodes(instrument)), field);
}

} // namespace vkfv::optics
