#include "topography/texture_place.hpp"

#include "core/parallel_rows.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <vector>

namespace vkfv::topography {
namespace {

struct Vector {
    double x = 0;
    double y = 0;
};

// Of what the window gathers in a column, about the row of its middle.
struct TextureColumn {
    double total = 0;
    double y = 0;
};

// Of the heights in a column: their number, their sum, and the moments of both.
struct HeightColumn {
    double count = 0;
    double y = 0;
    double yy = 0;
    double z = 0;
    double yz = 0;
    double zz = 0;
};

TextureColumn texture_column(const Grid<double>& responses, const FocusWindow& window, int column, int row) {
    TextureColumn sums;
    for (int d = -std::min(window.radius(), row); d <= std::min(window.radius(), responses.rows - 1 - row); ++d) {
        const double part = window.weights()[static_cast<std::size_t>(std::abs(d))] * responses(column, row + d);
        sums.total += part;
        sums.y += d * part;
    }
    return sums;
}

HeightColumn height_column(const Grid<double>& height, int reach, int column, int row) {
    HeightColumn sums;
    for (int d = -std::min(reach, row); d <= std::min(reach, height.rows - 1 - row); ++d) {
        const double z = height(column, row + d);
        if (std::isfinite(z)) {
            sums.count += 1;
            sums.y += d;
            sums.yy += d * d;
            sums.z += z;
            sums.yz += d * z;
            sums.zz += z * z;
        }
    }
    return sums;
}

// In pixels from the window's middle.
Vector texture_centre(const std::vector<TextureColumn>& columns, const FocusWindow& window, int column) {
    const int count = static_cast<int>(columns.size());
    double total = 0;
    Vector sum;
    for (int d = -std::min(window.radius(), column); d <= std::min(window.radius(), count - 1 - column); ++d) {
        const double weight = window.weights()[static_cast<std::size_t>(std::abs(d))];
        const TextureColumn& here = columns[static_cast<std::size_t>(column + d)];
        total += weight * here.total;
        sum.x += d * weight * here.total;
        sum.y += weight * here.y;
    }
    return total > 0 ? Vector{.x = sum.x / total, .y = sum.y / total} : Vector{};
}

// Height a pixel, of the least-squares plane; 0 where chance explains it. neighbours: heights that have a window in
// common, whose distances from the plane are one.
Vector slope(const std::vector<HeightColumn>& columns, int reach, double neighbours, int column) {
    const int count = static_cast<int>(columns.size());
    HeightColumn all;
    double x = 0, xx = 0, xy = 0, xz = 0;
    for (int d = -std::min(reach, column); d <= std::min(reach, count - 1 - column); ++d) {
        const HeightColumn& here = columns[static_cast<std::size_t>(column + d)];
        all.count += here.count;
        all.y += here.y;
        all.yy += here.yy;
        all.z += here.z;
        all.yz += here.yz;
        all.zz += here.zz;
        x += d * here.count;
        xx += d * d * here.count;
        xy += d * here.y;
        xz += d * here.z;
    }
    const double side = 2 * reach + 1;
    if (all.count < side * side / 2) {
        return {};
    }
    const auto about_means = [&](double product, double a, double b) { return product - a * b / all.count; };
    const double sxx = about_means(xx, x, x), sxy = about_means(xy, x, all.y), syy = about_means(all.yy, all.y, all.y);
    const double sxz = about_means(xz, x, all.z), syz = about_means(all.yz, all.y, all.z);
    const double determinant = sxx * syy - sxy * sxy;
    constexpr double least = 1e-3; // of the two moments' product: heights along a line have no plane
    if (!(determinant > least * sxx * syy)) {
        return {};
    }
    const Vector found{.x = (syy * sxz - sxy * syz) / determinant, .y = (sxx * syz - sxy * sxz) / determinant};
    const double off = std::max(0.0, about_means(all.zz, all.z, all.z) - found.x * sxz - found.y * syz) / all.count;
    const double by_chance = neighbours * off * (1 / sxx + 1 / syy);
    const double square = found.x * found.x + found.y * found.y;
    const double share = square > by_chance ? 1 - by_chance / square : 0;
    return {.x = share * found.x, .y = share * found.y};
}

} // namespace

void place_by_texture(Grid<double>& height, const Channels& all_in_focus, FocusMeasure measure,
                      const FocusWindow& window) {
    if (all_in_focus.empty() || all_in_focus[0].columns != height.columns || all_in_focus[0].rows != height.rows) {
        throw std::invalid_argument("place_by_texture: as many heights as pixels are needed");
    }
    const Grid<double> responses = focus_responses(all_in_focus, measure, window);
    // From one of them: sums of squares keep no digits of a height that all have in common.
    Grid<double> found = height;
    const auto first = std::ranges::find_if(height.values, [](double z) { return std::isfinite(z); });
    const double common = first == height.values.end() ? 0 : *first;
    for (double& z : found.values) {
        z -= common;
    }
    const int reach = 2 * window.radius();
    const double neighbours = window.pixels(2 * reach + 1, 2 * reach + 1, reach, reach);
    parallel_rows(height.columns, height.rows, [&](int from, int end) {
        std::vector<TextureColumn> textures(static_cast<std::size_t>(height.columns));
        std::vector<HeightColumn> heights(textures.size());
        for (int row = from; row < end; ++row) {
            for (int column = 0; column < height.columns; ++column) {
                textures[static_cast<std::size_t>(column)] = texture_column(responses, window, column, row);
                heights[static_cast<std::size_t>(column)] = height_column(found, reach, column, row);
            }
            for (int column = 0; column < height.columns; ++column) {
                if (std::isfinite(found(column, row))) {
                    const Vector centre = texture_centre(textures, window, column);
                    const Vector rise = slope(heights, reach, neighbours, column);
                    height(column, row) -= rise.x * centre.x + rise.y * centre.y;
                }
            }
        }
    });
}

} // namespace vkfv::topography
