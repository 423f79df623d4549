#include "core/threads/parallel_rows.hpp"
#include "specimen/analytic.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace vkfv::specimen {
namespace {

// The number of points per pixel in each direction, at the middles of equal parts.
constexpr int subdivision = 5;
constexpr double off_specimen = -std::numeric_limits<double>::infinity();

// The sample points of a band of pixel rows, and the height at each: off_specimen if there is no surface. Places are a
// regular grid, whose steps are the mean ones along rows and columns, plus an offset (`aside`).
class SamplePoints {
  public:
    SamplePoints(int columns, int first_row, int rows, const std::function<PixelArea(int column, int row)>& area_of)
        : heights(columns * subdivision, rows * subdivision, off_specimen),
          places_(columns * subdivision, rows * subdivision) {
        for (int row = 0; row < rows; ++row) {
            for (int column = 0; column < columns; ++column) {
                const PixelArea area = area_of(column, first_row + row);
                for (int j = 0; j < subdivision; ++j) {
                    for (int i = 0; i < subdivision; ++i) {
                        places_(column * subdivision + i, row * subdivision + j) =
                            area.middle + part_at(i) * area.along_row + part_at(j) * area.along_column;
                    }
                }
            }
        }
        measure(area_of(columns / 2, first_row + rows / 2));
    }

    // Calls function(x, y, height) for all points within a rectangle, and for some near it.
    template <class Function>
    void each(glm::dvec2 lower, glm::dvec2 upper, Function function) {
        if (!(upper.x >= lower_.x && lower.x <= upper_.x && upper.y >= lower_.y && lower.y <= upper_.y)) {
            return;
        }
        const Range range = range_of(lower, upper);
        for (int row = range.row_begin; row < range.row_end; ++row) {
            for (int column = range.column_begin; column < range.column_end; ++column) {
                const glm::dvec2& place = places_(column, row);
                function(place.x, place.y, heights(column, row));
            }
        }
    }

    Grid<double> heights;

  private:
    struct Range {
        int column_begin, column_end, row_begin, row_end;
    };

    static double part_at(int k) { return (k + 0.5) / subdivision - 0.5; }

    glm::dvec2 aside(int column, int row) const { return places_(column, row) - step_ * glm::dvec2(column, row); }

    void measure(const PixelArea& middle) {
        // The regular grid is rectangular; `aside` holds the rest.
        step_ = glm::dvec2(middle.along_row.x, middle.along_column.y) / static_cast<double>(subdivision);
        lower_ = upper_ = places_(0, 0);
        const glm::dvec2 origin = places_(0, 0);
        double steepest = 0;
        for (int row = 0; row < places_.rows; ++row) {
            for (int column = 0; column < places_.columns; ++column) {
                lower_ = glm::min(lower_, places_(column, row));
                upper_ = glm::max(upper_, places_(column, row));
                const glm::dvec2 here = aside(column, row);
                farthest_aside_ = glm::max(farthest_aside_, glm::abs((here - origin) / step_));
                const glm::dvec2 along = column > 0 ? (here - aside(column - 1, row)) / step_ : glm::dvec2(0);
                const glm::dvec2 across = row > 0 ? (here - aside(column, row - 1)) / step_ : glm::dvec2(0);
                for (const glm::dvec2& change : {along, across}) {
                    steepest = std::max({steepest, std::abs(change.x), std::abs(change.y)});
                }
            }
        }
        constexpr double rounding = 1e-9;
        steepest_ = steepest + rounding;
    }

    int clamped(double value, int limit) const {
        return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(limit)));
    }

    // The points whose places may lie in the rectangle. From a point q, a place changes by step_ times the distance in
    // columns and rows, and its offset by at most steepest_ times the sum of both. So with the rectangle's bounds
    // relative to q's place, in steps, a column of a point within exceeds the bounds by at most steepest_ times that
    // sum, which is bounded likewise.
    Range range_of(glm::dvec2 lower, glm::dvec2 upper) const {
        const int columns = places_.columns;
        const int rows = places_.rows;
        const glm::dvec2 middle = 0.5 * (lower + upper);
        // A few corrections find a point near the rectangle's middle; its nearness only saves time.
        glm::ivec2 q(columns / 2, rows / 2);
        for (int correction = 0; correction < 3; ++correction) {
            const glm::dvec2 towards = (middle - aside(q.x, q.y)) / step_;
            q = {clamped(std::round(towards.x), columns - 1), clamped(std::round(towards.y), rows - 1)};
        }
        const glm::dvec2 one = (lower - places_(q.x, q.y)) / step_;
        const glm::dvec2 other = (upper - places_(q.x, q.y)) / step_;
        const glm::dvec2 least = glm::min(one, other);
        const glm::dvec2 most = glm::max(one, other);
        const glm::dvec2 reach = glm::max(glm::abs(least), glm::abs(most));
        constexpr double steep = 0.4;
        glm::dvec2 margin = 2.0 * farthest_aside_;
        if (steepest_ < steep) {
            margin = glm::min(margin, glm::dvec2(steepest_ * (reach.x + reach.y) / (1 - 2 * steepest_)));
        }
        // One more point on either side allows for rounding; the caller's function decides.
        return {.column_begin = clamped(std::floor(q.x + least.x - margin.x) - 1, columns),
                .column_end = clamped(std::ceil(q.x + most.x + margin.x) + 2, columns),
                .row_begin = clamped(std::floor(q.y + least.y - margin.y) - 1, rows),
                .row_end = clamped(std::ceil(q.y + most.y + margin.y) + 2, rows)};
    }

    Grid<glm::dvec2> places_;
    glm::dvec2 step_ = glm::dvec2(1); // mm, between neighbouring points
    glm::dvec2 lower_ = glm::dvec2(0);
    glm::dvec2 upper_ = glm::dvec2(0);
    glm::dvec2 farthest_aside_ = glm::dvec2(0); // largest change of `aside` from the first point's, in steps
    double steepest_ = 0;                       // largest change of `aside` between neighbouring points, in steps
};

// Twice the signed area of (a, b, p), computed from the same numbers for either order of a and b, so that two triangles
// never both miss a point on their common edge.
double edge(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p) {
    const bool ordered = a.x < b.x || (a.x == b.x && a.y < b.y);
    const glm::dvec2& from = ordered ? a : b;
    const glm::dvec2& to = ordered ? b : a;
    const double area = (to.x - from.x) * (p.y - from.y) - (to.y - from.y) * (p.x - from.x);
    return ordered ? area : -area;
}

struct Fill {
    SamplePoints& points;

    void operator()(const HeightField& field) const {
        const auto height_at = [&](double x, double y, double& height) {
            const double u = (x - field.x_min) / field.pitch_x;
            const double v = (y - field.y_min) / field.pitch_y;
            const Grid<float>& h = field.heights;
            if (u < 0 || v < 0 || u > h.columns - 1 || v > h.rows - 1) {
                return;
            }
            const int i = std::min(static_cast<int>(u), h.columns - 2);
            const int j = std::min(static_cast<int>(v), h.rows - 2);
            const double a = u - i;
            const double b = v - j;
            const auto known = [&](int column, int row) {
                return field.interpolated.empty() || !field.interpolated[h.index(column, row)];
            };
            if (!known(i, j) || !known(i + 1, j + 1) || !(a >= b ? known(i + 1, j) : known(i, j + 1))) {
                return;
            }
            const double low = static_cast<double>(h(i, j));
            const double high = static_cast<double>(h(i + 1, j + 1));
            // The diagonal runs from (i, j) to (i+1, j+1): below it the corner is (i+1, j), above it (i, j+1).
            const double corner = static_cast<double>(a >= b ? h(i + 1, j) : h(i, j + 1));
            const double larger = std::max(a, b);
            const double smaller = std::min(a, b);
            height = low + larger * (corner - low) + smaller * (high - corner);
        };
        points.each({field.x_min, field.y_min}, {field.x_max(), field.y_max()}, height_at);
    }

    void operator()(const Mesh& mesh) const {
        for (const glm::uvec3& triangle : mesh.triangles) {
            const glm::dvec3 a(mesh.vertices[triangle.x]);
            const glm::dvec3 b(mesh.vertices[triangle.y]);
            const glm::dvec3 c(mesh.vertices[triangle.z]);
            const glm::dvec3 lower = glm::min(a, glm::min(b, c));
            const glm::dvec3 upper = glm::max(a, glm::max(b, c));
            points.each(glm::dvec2(lower), glm::dvec2(upper), [&](double x, double y, double& height) {
                const glm::dvec2 p(x, y);
                const double u = edge(glm::dvec2(b), glm::dvec2(c), p);
                const double v = edge(glm::dvec2(c), glm::dvec2(a), p);
                const double w = edge(glm::dvec2(a), glm::dvec2(b), p);
                const bool inside = (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
                const double sum = u + v + w;
                if (inside && sum != 0) { // a vertical triangle covers no point
                    height = std::max(height, (u * a.z + v * b.z + w * c.z) / sum);
                }
            });
        }
    }

    void operator()(const Analytic& analytic) const {
        const physics::f64::SpecimenRecord record = specimen::record({analytic, {}}, 1);
        const LatticeScene scene{analytic.lattice ? &*analytic.lattice : nullptr};
        const auto height_at = [&](double x, double y, double& height) {
            if (x >= analytic.x_min && x <= analytic.x_max && y >= analytic.y_min && y <= analytic.y_max) {
                height = physics::f64::surface_height(scene, record, x, y).height;
            }
        };
        points.each({analytic.x_min, analytic.y_min}, {analytic.x_max, analytic.y_max}, height_at);
    }
};

} // namespace

surface::HeightMap truth(const Specimen& specimen, const PixelGrid& grid,
                         const std::function<PixelArea(int column, int row)>& area_of) {
    surface::HeightMap map{.height = Grid<double>(grid.columns, grid.rows),
                           .x0 = grid.x0,
                           .y0 = grid.y0,
                           .pitch_x = grid.pitch_x,
                           .pitch_y = grid.pitch_y};
    // Bands of rows keep the memory of a large detector's points within some megabytes a thread.
    const int points_per_row = grid.columns * subdivision * subdivision;
    const int band = std::max(1, (1 << 20) / std::max(1, points_per_row));
    parallel_bands(grid.rows, band, [&](int first, int end) {
        const int count = end - first;
        SamplePoints points(grid.columns, first, count, area_of);
        std::visit(Fill{points}, specimen.geometry);
        for (int row = 0; row < count; ++row) {
            for (int column = 0; column < grid.columns; ++column) {
                double sum = 0;
                for (int j = 0; j < subdivision; ++j) {
                    for (int i = 0; i < subdivision; ++i) {
                        sum += points.heights(column * subdivision + i, row * subdivision + j);
                    }
                }
                map.height(column, first + row) =
                    std::isfinite(sum) ? sum / (subdivision * subdivision) : std::numeric_limits<double>::quiet_NaN();
            }
        }
    });
    return map;
}

surface::HeightMap truth(const Specimen& specimen, int columns, int rows, double x0, double y0, double pitch_x,
                         double pitch_y) {
    const PixelGrid grid{.columns = columns, .rows = rows, .x0 = x0, .y0 = y0, .pitch_x = pitch_x, .pitch_y = pitch_y};
    return truth(specimen, grid, [&](int column, int row) {
        return PixelArea{.middle = {x0 + column * pitch_x, y0 + row * pitch_y},
                         .along_row = {pitch_x, 0},
                         .along_column = {0, pitch_y}};
    });
}

} // namespace vkfv::specimen
