#include "trace/structures/pyramid.hpp"
#include "trace/structures/outward.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace vkfv::trace {

namespace {

// Largest blocks have 64 x 64 cells: a ray through relief as high as it is wide crosses few such blocks, and the
// padding to whole blocks stays small.
constexpr int largest_level = 6;

// Number of tiles along each side of an analytic surface without a lattice: a range is then within 1/180 of the
// footprint's side times the slope of the surface.
constexpr int tiles_along_side = 128;

int padded(int cells, int level) {
    return ((cells + (1 << level) - 1) >> level) << level;
}

PyramidHeader make_header(int cells_x, int cells_y) {
    PyramidHeader header;
    header.cells_x = cells_x;
    header.cells_y = cells_y;
    while (header.top_level < largest_level && (1 << header.top_level) < std::max(cells_x, cells_y)) {
        ++header.top_level;
    }
    header.padded_x = padded(cells_x, header.top_level);
    header.padded_y = padded(cells_y, header.top_level);
    return header;
}

std::size_t first_of_level(const PyramidHeader& header, int level) {
    const std::size_t finest = static_cast<std::size_t>(header.padded_x) * static_cast<std::size_t>(header.padded_y);
    return 4 * (finest - (finest >> (2 * level))) / 3;
}

// Builds a pyramid. cell_range(column, row) encloses the surface over a cell; rounding widens it.
Pyramid build(PyramidHeader header, double rounding, const std::function<glm::dvec2(int, int)>& cell_range) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    Pyramid pyramid;
    pyramid.header = header;
    pyramid.ranges.assign(first_of_level(header, header.top_level + 1), glm::vec2(infinity, -infinity));
    for (int row = 0; row < header.cells_y; ++row) {
        for (int column = 0; column < header.cells_x; ++column) {
            const glm::dvec2 range = cell_range(column, row);
            pyramid.ranges[static_cast<std::size_t>(row) * static_cast<std::size_t>(header.padded_x) +
                           static_cast<std::size_t>(column)] =
                glm::vec2(next_below(static_cast<float>(range.x - rounding)),
                          next_above(static_cast<float>(range.y + rounding)));
        }
    }
    for (int level = 1; level <= header.top_level; ++level) {
        for (int row = 0; row < header.padded_y >> level; ++row) {
            for (int column = 0; column < header.padded_x >> level; ++column) {
                glm::vec2 range(infinity, -infinity);
                for (int child = 0; child < 4; ++child) {
                    const glm::vec2 part = pyramid.range(level - 1, 2 * column + (child & 1), 2 * row + (child >> 1));
                    range = glm::vec2(std::min(range.x, part.x), std::max(range.y, part.y));
                }
                pyramid.ranges[first_of_level(header, level) +
                               static_cast<std::size_t>(row) * static_cast<std::size_t>(header.padded_x >> level) +
                               static_cast<std::size_t>(column)] = range;
            }
        }
    }
    return pyramid;
}

// Bound of float rounding: four steps (2^-23) of the largest coordinate, as specimen_rounding() in
// shaders/device/specimen_hit.glsl.
double float_rounding(double x_min, double x_max, double y_min, double y_max, double height) {
    return 4 * 0x1p-23 *
           std::max({std::abs(x_min), std::abs(x_max), std::abs(y_min), std::abs(y_max), std::abs(height)});
}

double largest_height(const specimen::HeightField& field) {
    double largest = 0;
    for (const float height : field.heights.values) {
        largest = std::max(largest, std::abs(static_cast<double>(height)));
    }
    return largest;
}

// The coarse level of ceilings. Light at NA 0.45 goes half as far across as down. Where blocks are about as large as
// its way across through the whole relief, one jump brings it close to the surface, and one over finer blocks to within
// a few cells of the meeting.
int coarse_level_for(double relief, double cell, int cells) {
    const int suitable = std::ilogb(std::max(0.5 * relief / cell, 1.0));
    return std::clamp(
        suitable, 1,
        std::max(1, std::min(largest_level, static_cast<int>(std::bit_width(static_cast<unsigned>(cells - 1))))));
}

// The highest points of blocks of twice the side. highest: of the blocks, row-major.
Grid<float> halved(const Grid<float>& highest) {
    Grid<float> result((highest.columns + 1) / 2, (highest.rows + 1) / 2);
    std::ranges::fill(result.values, -std::numeric_limits<float>::infinity());
    for (int row = 0; row < highest.rows; ++row) {
        for (int column = 0; column < highest.columns; ++column) {
            float& block = result(column / 2, row / 2);
            block = std::max(block, highest(column, row));
        }
    }
    return result;
}

void append_ceilings(std::vector<float>& ceilings, const Grid<float>& highest) {
    for (int row = 0; row < highest.rows; ++row) {
        for (int column = 0; column < highest.columns; ++column) {
            float ceiling = highest(column, row);
            for (int j = std::max(row - 1, 0); j <= std::min(row + 1, highest.rows - 1); ++j) {
                for (int i = std::max(column - 1, 0); i <= std::min(column + 1, highest.columns - 1); ++i) {
                    ceiling = std::max(ceiling, highest(i, j));
                }
            }
            ceilings.push_back(ceiling);
        }
    }
}

// Makes the ceilings. highest: of each cell, mm; steepest: bound of the slope; relief: highest less lowest height, mm.
Ceilings ceilings_over(Grid<float> highest, double cell_x, double cell_y, double steepest, double relief) {
    Ceilings result;
    kernels::CeilingsHeader& header = result.header;
    header.cells_x = highest.columns;
    header.cells_y = highest.rows;
    header.per_x = static_cast<float>(1 / cell_x);
    header.per_y = static_cast<float>(1 / cell_y);
    header.steepest = static_cast<float>(steepest);
    header.coarse_level = coarse_level_for(relief, std::min(cell_x, cell_y), std::max(highest.columns, highest.rows));
    header.fine_level = std::max(1, header.coarse_level / 2);
    for (int level = 1; level <= header.coarse_level; ++level) {
        highest = halved(highest);
        if (level == header.fine_level) {
            header.fine_columns = highest.columns;
            append_ceilings(result.heights, highest);
        }
    }
    header.coarse_columns = highest.columns;
    header.coarse_first = static_cast<std::int32_t>(result.heights.size());
    append_ceilings(result.heights, highest);
    return result;
}

} // namespace

glm::vec2 Pyramid::range(int level, int column, int row) const {
    return ranges[first_of_level(header, level) +
                  static_cast<std::size_t>(row) * static_cast<std::size_t>(header.padded_x >> level) +
                  static_cast<std::size_t>(column)];
}

glm::ivec2 pyramid_cells(const specimen::Analytic& surface) {
    return surface.lattice ? glm::ivec2(surface.lattice->heights.columns - 1, surface.lattice->heights.rows - 1)
                           : glm::ivec2(tiles_along_side);
}

Pyramid make_pyramid(const specimen::Analytic& surface, const physics::f64::SpecimenRecord& shape) {
    const glm::ivec2 cells = pyramid_cells(surface);
    PyramidHeader header = make_header(cells.x, cells.y);
    const double cell_x = (surface.x_max - surface.x_min) / cells.x;
    const double cell_y = (surface.y_max - surface.y_min) / cells.y;
    header.cell_x = static_cast<float>(cell_x);
    header.cell_y = static_cast<float>(cell_y);
    // A slope turns the rounding of a lateral position into one of the height.
    const double height = std::max(std::abs(shape.bottom), std::abs(shape.top)) +
                          (surface.lattice ? largest_height(*surface.lattice) : 0);
    const double rounding =
        float_rounding(surface.x_min, surface.x_max, surface.y_min, surface.y_max, height) * (1 + shape.lipschitz);
    const double reach = shape.lipschitz * 0.5 * std::hypot(cell_x, cell_y);
    return build(header, rounding, [&](int column, int row) {
        const double centre = physics::f64::shape_height(shape, surface.x_min + (column + 0.5) * cell_x,
                                                         surface.y_min + (row + 0.5) * cell_y)
                                  .height;
        glm::dvec2 range(centre - reach, centre + reach);
        if (surface.lattice) {
            const Grid<float>& heights = surface.lattice->heights;
            double lowest = std::numeric_limits<double>::infinity();
            double highest = -lowest;
            for (int j = -1; j <= 2; ++j) {
                for (int i = -1; i <= 2; ++i) {
                    const double point = heights(std::clamp(column + i, 0, heights.columns - 1),
                                                 std::clamp(row + j, 0, heights.rows - 1));
                    lowest = std::min(lowest, point);
                    highest = std::max(highest, point);
                }
            }
            // The negative weights of cubic convolution add up to u (1 - u) / 2 <= 1/8 along a line, so the
            // sizes of all weights to at most (5/4)^2 in the plane, and its negative ones to (25/16 - 1) / 2.
            const double overshoot = 9.0 / 32.0 * (highest - lowest);
            range += glm::dvec2(lowest - overshoot, highest + overshoot);
        }
        return range;
    });
}

Ceilings make_ceilings(const specimen::HeightField& field) {
    const Grid<float>& heights = field.heights;
    const auto [bottom, top] = std::ranges::minmax(heights.values);
    const double rounding =
        float_rounding(field.x_min, field.x_max(), field.y_min, field.y_max(), largest_height(field));
    Grid<float> highest(heights.columns - 1, heights.rows - 1);
    double steepest = 0; // squared slope
    for (int row = 0; row < highest.rows; ++row) {
        for (int column = 0; column < highest.columns; ++column) {
            const double corner = heights(column, row);
            const double right = heights(column + 1, row);
            const double above = heights(column, row + 1);
            const double across = heights(column + 1, row + 1);
            const auto squared_slope = [&](double rise_x, double rise_y) {
                const double x = rise_x / field.pitch_x;
                const double y = rise_y / field.pitch_y;
                return x * x + y * y;
            };
            steepest = std::max(
                {steepest, squared_slope(right - corner, across - right), squared_slope(across - above, above - corner),
                 squared_slope(right - corner, above - corner), squared_slope(across - above, across - right)});
            highest(column, row) =
                std::nextafter(static_cast<float>(std::max({corner, right, above, across}) + rounding),
                               std::numeric_limits<float>::infinity());
        }
    }
    // The factor exceeds float arithmetic's error of a slope by far.
    return ceilings_over(std::move(highest), field.pitch_x, field.pitch_y, 1.0001 * std::sqrt(steepest),
                         static_cast<double>(top) - static_cast<double>(bottom));
}

Ceilings make_ceilings(const Pyramid& pyramid, double relief) {
    const PyramidHeader& header = pyramid.header;
    Grid<float> highest(header.cells_x, header.cells_y);
    for (int row = 0; row < highest.rows; ++row) {
        for (int column = 0; column < highest.columns; ++column) {
            highest(column, row) = pyramid.range(0, column, row).y;
        }
    }
    constexpr double never = 1e30; // a march finds out by itself that it escapes
    return ceilings_over(std::move(highest), header.cell_x, header.cell_y, never, relief);
}

} // namespace vkfv::trace
