#include "specimen/description.hpp"

#include "core/mathematics/units.hpp"
#include "core/threads/parallel_rows.hpp"
#include "specimen/analytic.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <span>
#include <vector>

namespace vkfv::specimen {
namespace {

using physics::f64::SpecimenRecord;

struct Bounds {
    double lower = std::numeric_limits<double>::infinity();
    double upper = -std::numeric_limits<double>::infinity();
    void include(double value) {
        lower = std::min(lower, value);
        upper = std::max(upper, value);
    }
};

// Rigorous bounds, cell by cell, of the bicubic interpolation of surface_function.glsl: in one direction the weights
// sum to 1, the sum of their moduli is at most 5/4 (in the middle of an interval), and the largest slope of a cubic
// over an interval is at an end or where its second derivative is zero.
struct LatticeBounds {
    Bounds height;
    double slope = 0;
    void include(const LatticeBounds& other) {
        height.lower = std::min(height.lower, other.height.lower);
        height.upper = std::max(height.upper, other.height.upper);
        slope = std::max(slope, other.slope);
    }
};

constexpr double largest_weight_sum = 1.25;

double largest_cubic_slope(const std::array<double, 4>& h) {
    const double at_start = 0.5 * (h[2] - h[0]);
    const double at_end = 0.5 * (h[3] - h[1]);
    const double second = h[0] - 2.5 * h[1] + 2 * h[2] - 0.5 * h[3]; // coefficient of u^2
    const double third = 0.5 * (h[3] - h[0]) + 1.5 * (h[1] - h[2]);  // coefficient of u^3
    double largest = std::max(std::abs(at_start), std::abs(at_end));
    const double u = -second / (3 * third);
    if (u > 0 && u < 1) {
        largest = std::max(largest, std::abs(at_start + u * (2 * second + u * 3 * third)));
    }
    return largest;
}

// Bounds over the four points about each interval between neighbouring columns of a row.
struct RowIntervals {
    std::vector<double> lowest;
    std::vector<double> highest;
    std::vector<double> slope; // slope along x times the pitch

    explicit RowIntervals(std::span<const float> heights)
        : lowest(heights.size() - 1), highest(lowest.size()), slope(lowest.size()) {
        const std::size_t last = heights.size() - 1;
        for (std::size_t column = 0; column < last; ++column) {
            std::array<double, 4> points{};
            for (std::size_t i = 0; i < 4; ++i) {
                points[i] = static_cast<double>(heights[std::min(last, std::max(column + i, std::size_t{1}) - 1)]);
            }
            lowest[column] = std::min(std::min(points[0], points[1]), std::min(points[2], points[3]));
            highest[column] = std::max(std::max(points[0], points[1]), std::max(points[2], points[3]));
            slope[column] = largest_cubic_slope(points);
        }
    }
};

// Bounds of the cells between `row` and the next; rows: the intervals of the four rows about them.
LatticeBounds bounds_of_cells(const HeightField& lattice, int row, const std::array<const RowIntervals*, 4>& rows,
                              std::vector<double>& slopes_y) {
    const Grid<float>& heights = lattice.heights;
    slopes_y.resize(static_cast<std::size_t>(heights.columns));
    for (int column = 0; column < heights.columns; ++column) {
        std::array<double, 4> points{};
        for (int j = 0; j < 4; ++j) {
            points[static_cast<std::size_t>(j)] =
                static_cast<double>(heights(column, std::clamp(row + j - 1, 0, heights.rows - 1)));
        }
        slopes_y[static_cast<std::size_t>(column)] = largest_cubic_slope(points);
    }
    LatticeBounds result;
    double steepest_square = 0;
    const std::size_t last = slopes_y.size() - 1;
    for (std::size_t column = 0; column < last; ++column) {
        double lower = rows[0]->lowest[column], upper = rows[0]->highest[column];
        double slope_x = 0, slope_y = 0;
        for (std::size_t j = 0; j < 4; ++j) {
            lower = std::min(lower, rows[j]->lowest[column]);
            upper = std::max(upper, rows[j]->highest[column]);
            slope_x = std::max(slope_x, rows[j]->slope[column]);
            slope_y = std::max(slope_y, slopes_y[std::min(last, std::max(column + j, std::size_t{1}) - 1)]);
        }
        const double middle = 0.5 * (lower + upper);
        const double reach = largest_weight_sum * largest_weight_sum * (upper - middle);
        result.height.include(middle - reach);
        result.height.include(middle + reach);
        slope_x /= lattice.pitch_x;
        slope_y /= lattice.pitch_y;
        // The comparison of squares avoids the slow hypot() for all but the few cells steeper than those before.
        constexpr double rounding = 1e-12;
        const double square = slope_x * slope_x + slope_y * slope_y;
        if (square >= (1 - rounding) * steepest_square) {
            steepest_square = std::max(steepest_square, square);
            result.slope = std::max(result.slope, largest_weight_sum * std::hypot(slope_x, slope_y));
        }
    }
    return result;
}

LatticeBounds bounds_of(const HeightField& lattice) {
    constexpr int band = 64;
    const Grid<float>& heights = lattice.heights;
    LatticeBounds result;
    std::mutex merging;
    parallel_bands(heights.rows - 1, band, [&](int first, int end) {
        const int lowest_row = std::max(0, first - 1), highest_row = std::min(heights.rows - 1, end + 1);
        std::vector<RowIntervals> rows;
        for (int row = lowest_row; row <= highest_row; ++row) {
            rows.emplace_back(
                std::span(heights.values).subspan(heights.index(0, row), static_cast<std::size_t>(heights.columns)));
        }
        LatticeBounds own;
        std::vector<double> slopes_y;
        for (int row = first; row < end; ++row) {
            std::array<const RowIntervals*, 4> about{};
            for (int j = 0; j < 4; ++j) {
                about[static_cast<std::size_t>(j)] =
                    &rows[static_cast<std::size_t>(std::clamp(row + j - 1, lowest_row, highest_row) - lowest_row)];
            }
            own.include(bounds_of_cells(lattice, row, about, slopes_y));
        }
        const std::scoped_lock lock(merging);
        result.include(own);
    });
    return result;
}

struct ShapeBounds {
    Bounds height;
    double slope = 0;
};

ShapeBounds bounds_of_shape(const Analytic& a) {
    ShapeBounds result;
    const double* p = a.parameters;
    const double far_x = std::max(std::abs(a.x_min), std::abs(a.x_max));
    const double far_y = std::max(std::abs(a.y_min), std::abs(a.y_max));
    switch (a.shape) {
    case physics::f64::SHAPE_PLANE:
        for (const double x : {a.x_min, a.x_max}) {
            for (const double y : {a.y_min, a.y_max}) {
                result.height.include(p[0] * x + p[1] * y);
            }
        }
        result.slope = std::hypot(p[0], p[1]);
        break;
    case physics::f64::SHAPE_STEP:
        result.height.include(-0.5 * p[0]);
        result.height.include(0.5 * p[0]);
        result.slope = std::abs(p[0]) / p[1];
        break;
    case physics::f64::SHAPE_SPHERE: {
        const double cap = std::abs(p[1]);
        result.height.include(0);
        result.height.include(p[1]);
        // The slope is greatest at the cap's rim or, if that lies outside, at the footprint's corner.
        const double r_squared = std::min(cap * (2 * p[0] - cap), far_x * far_x + far_y * far_y);
        result.slope = std::sqrt(r_squared / (p[0] * p[0] - r_squared));
        break;
    }
    default: // sinusoid and chirp
        result.height.include(-std::abs(p[0]));
        result.height.include(std::abs(p[0]));
        result.slope = std::abs(p[0]) * 2 * pi / (a.shape == physics::f64::SHAPE_CHIRP ? std::min(p[1], p[2]) : p[1]);
        break;
    }
    return result;
}

struct Recorder {
    SpecimenRecord& record;

    void grid(const HeightField& field) const {
        record.x_min = field.x_min;
        record.y_min = field.y_min;
        record.x_max = field.x_max();
        record.y_max = field.y_max();
        record.pitch_x = field.pitch_x;
        record.pitch_y = field.pitch_y;
        record.columns = field.heights.columns;
        record.rows = field.heights.rows;
    }
    void operator()(const HeightField& field) const {
        record.kind = physics::f64::SPECIMEN_FACETS;
        grid(field);
        const auto [lowest, highest] = std::minmax_element(field.heights.values.begin(), field.heights.values.end());
        record.bottom = static_cast<double>(*lowest);
        record.top = static_cast<double>(*highest);
    }
    void operator()(const Mesh& mesh) const {
        record.kind = physics::f64::SPECIMEN_MESH;
        Bounds x, y, z;
        for (const glm::vec3& vertex : mesh.vertices) {
            x.include(static_cast<double>(vertex.x));
            y.include(static_cast<double>(vertex.y));
            z.include(static_cast<double>(vertex.z));
        }
        record.x_min = x.lower;
        record.x_max = x.upper;
        record.y_min = y.lower;
        record.y_max = y.upper;
        record.bottom = z.lower;
        record.top = z.upper;
    }
    void operator()(const Analytic& analytic) const {
        record.kind = physics::f64::SPECIMEN_ANALYTIC;
        const ShapeBounds shape = bounds_of_shape(analytic);
        record.bottom = shape.height.lower;
        record.top = shape.height.upper;
        record.lipschitz = shape.slope;
        if (analytic.lattice) {
            grid(*analytic.lattice);
            const LatticeBounds lattice = bounds_of(*analytic.lattice);
            record.bottom += lattice.height.lower;
            record.top += lattice.height.upper;
            record.lipschitz += lattice.slope;
        }
        record.lipschitz *= 1 + std::numeric_limits<float>::epsilon(); // rounding up, so that it stays a bound in float
        record.x_min = analytic.x_min;
        record.y_min = analytic.y_min;
        record.x_max = analytic.x_max;
        record.y_max = analytic.y_max;
        record.shape = analytic.shape;
        record.shape_parameter_0 = analytic.parameters[0];
        record.shape_parameter_1 = analytic.parameters[1];
        record.shape_parameter_2 = analytic.parameters[2];
        record.shape_parameter_3 = analytic.parameters[3];
    }
};

} // namespace

SpecimenRecord record_of_lattice(const HeightField& lattice) {
    SpecimenRecord result{};
    result.kind = physics::f64::SPECIMEN_ANALYTIC;
    result.shape = physics::f64::SHAPE_PLANE;
    Recorder{result}.grid(lattice);
    return result;
}

SpecimenRecord record_of_geometry(const Specimen& specimen) {
    SpecimenRecord result{};
    std::visit(Recorder{result}, specimen.geometry);
    if (specimen.reflectance) {
        result.reflectance = specimen.reflectance->record;
    }
    // A distance between the plane z = top, where rays start, and the surface, also if it is level and rounded to
    // float: 128 float steps of the largest coordinate.
    const double largest = std::max({std::abs(result.x_min), std::abs(result.x_max), std::abs(result.y_min),
                                     std::abs(result.y_max), std::abs(result.bottom), std::abs(result.top)});
    const double margin = 128 * static_cast<double>(std::numeric_limits<float>::epsilon()) * largest;
    result.bottom -= margin;
    result.top += margin;
    return result;
}

SpecimenRecord record(const Specimen& specimen, int max_bounces) {
    SpecimenRecord result = record_of_geometry(specimen);
    result.material = material_record(specimen.material);
    result.material_spectral_points = material_numbers(specimen.material).spectral_points;
    result.max_bounces = max_bounces;
    return result;
}

Footprint footprint(const Specimen& specimen) {
    if (const auto* field = std::get_if<HeightField>(&specimen.geometry)) {
        return {field->x_min, field->y_min, field->x_max(), field->y_max()};
    }
    if (const auto* analytic = std::get_if<Analytic>(&specimen.geometry)) {
        return {analytic->x_min, analytic->y_min, analytic->x_max, analytic->y_max};
    }
    const SpecimenRecord r = record_of_geometry(specimen);
    return {r.x_min, r.y_min, r.x_max, r.y_max};
}

} // namespace vkfv::specimen
