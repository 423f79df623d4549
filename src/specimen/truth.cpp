#include "core/threads/parallel_rows.hpp"
#include "specimen/analytic.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace vkfv::specimen {
namespace {

// Points per pixel and direction, at the middles of equal parts.
constexpr int subdivision = 5;
constexpr double off_specimen = -std::numeric_limits<double>::infinity();

// The points of a band of pixel rows.
struct SamplePoints {
    double x0, y0, pitch_x, pitch_y; // of the pixels
    int first_row;                   // of points
    Grid<double> heights;            // off_specimen where there is none

    double x(int column) const { return x0 + ((column + 0.5) / subdivision - 0.5) * pitch_x; }
    double y(int row) const { return y0 + ((first_row + row + 0.5) / subdivision - 0.5) * pitch_y; }
};

// Twice the signed area of (a, b, p), computed for either order of a and b from the same numbers, so that two
// triangles never both leave out a point on their common edge.
double edge(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p) {
    const bool ordered = a.x < b.x || (a.x == b.x && a.y < b.y);
    const glm::dvec2& from = ordered ? a : b;
    const glm::dvec2& to = ordered ? b : a;
    const double area = (to.x - from.x) * (p.y - from.y) - (to.y - from.y) * (p.x - from.x);
    return ordered ? area : -area;
}

struct Fill {
    SamplePoints& points;

    template <class Function>
    void each(double x_min, double x_max, double y_min, double y_max, Function function) const {
        const auto index = [](double value, int limit) {
            return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(limit)));
        };
        // One more on either side for rounding; the function decides.
        const double step_x = points.pitch_x / subdivision;
        const double step_y = points.pitch_y / subdivision;
        const int columns = points.heights.columns;
        const int rows = points.heights.rows;
        const int column_begin = index(std::floor((x_min - points.x(0)) / step_x) - 1, columns);
        const int column_end = index(std::ceil((x_max - points.x(0)) / step_x) + 2, columns);
        const int row_begin = index(std::floor((y_min - points.y(0)) / step_y) - 1, rows);
        const int row_end = index(std::ceil((y_max - points.y(0)) / step_y) + 2, rows);
        for (int row = row_begin; row < row_end; ++row) {
            for (int column = column_begin; column < column_end; ++column) {
                function(points.x(column), points.y(row), points.heights(column, row));
            }
        }
    }

    void operator()(const HeightField& field) const {
        each(field.x_min, field.x_max(), field.y_min, field.y_max(), [&](double x, double y, double& height) {
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
            // The diagonal runs from (i, j) to (i+1, j+1): below it the corner (i+1, j), above it (i, j+1).
            const double corner = static_cast<double>(a >= b ? h(i + 1, j) : h(i, j + 1));
            const double larger = std::max(a, b);
            const double smaller = std::min(a, b);
            height = low + larger * (corner - low) + smaller * (high - corner);
        });
    }

    void operator()(const Mesh& mesh) const {
        for (const glm::uvec3& triangle : mesh.triangles) {
            const glm::dvec3 a(mesh.vertices[triangle.x]);
            const glm::dvec3 b(mesh.vertices[triangle.y]);
            const glm::dvec3 c(mesh.vertices[triangle.z]);
            const glm::dvec3 lower = glm::min(a, glm::min(b, c));
            const glm::dvec3 upper = glm::max(a, glm::max(b, c));
            each(lower.x, upper.x, lower.y, upper.y, [&](double x, double y, double& height) {
                const glm::dvec2 p(x, y);
                const double u = edge(glm::dvec2(b), glm::dvec2(c), p);
                const double v = edge(glm::dvec2(c), glm::dvec2(a), p);
                const double w = edge(glm::dvec2(a), glm::dvec2(b), p);
                const bool inside = (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
                const double sum = u + v + w;
                if (inside && sum != 0) { // a vertical triangle covers nothing
                    height = std::max(height, (u * a.z + v * b.z + w * c.z) / sum);
                }
            });
        }
    }

    void operator()(const Analytic& analytic) const {
        const physics::f64::SpecimenRecord record = specimen::record({analytic, {}}, 1);
        const LatticeScene scene{analytic.lattice ? &*analytic.lattice : nullptr};
        each(analytic.x_min, analytic.x_max, analytic.y_min, analytic.y_max, [&](double x, double y, double& height) {
            if (x >= analytic.x_min && x <= analytic.x_max && y >= analytic.y_min && y <= analytic.y_max) {
                height = physics::f64::surface_height(scene, record, x, y).height;
            }
        });
    }
};

} // namespace

surface::HeightMap truth(const Specimen& specimen, int columns, int rows, double x0, double y0, double pitch_x,
                         double pitch_y) {
    surface::HeightMap map;
    map.height = Grid<double>(columns, rows);
    map.x0 = x0;
    map.y0 = y0;
    map.pitch_x = pitch_x;
    map.pitch_y = pitch_y;
    // Bands of rows keep the points of a large detector within some megabytes a thread.
    const int points_per_row = columns * subdivision * subdivision;
    const int band = std::max(1, (1 << 20) / std::max(1, points_per_row));
    parallel_bands(rows, band, [&](int first, int end) {
        const int count = end - first;
        SamplePoints points{x0,
                            y0,
                            pitch_x,
                            pitch_y,
                            first * subdivision,
                            Grid<double>(columns * subdivision, count * subdivision, off_specimen)};
        std::visit(Fill{points}, specimen.geometry);
        for (int row = 0; row < count; ++row) {
            for (int column = 0; column < columns; ++column) {
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

} // namespace vkfv::specimen
