#include "topography/texture_place.hpp"

#include "core/threads/parallel_rows.hpp"
#include "topography/local_plane.hpp"

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

// Sums of the texture that the window has in a column, and of its moment about the window's middle row.
struct TextureColumn {
    double total = 0;
    double y = 0;
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

// The centre of the window's texture, in pixels from the window's middle.
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

// Slope of the least-squares plane, height a pixel, over a window of so many pixels a side; 0 where chance explains it.
// neighbours: number of heights that share a window, whose distances from the plane count as one.
Vector slope(const PlaneMoments& around, double side, double neighbours) {
    if (around.weight < side * side / 2) {
        return {};
    }
    const LocalPlane plane = plane_of(around);
    const double sxx = around.about_means(around.xx, around.x, around.x);
    const double syy = around.about_means(around.yy, around.y, around.y);
    const double sxz = around.about_means(around.xz, around.x, around.z);
    const double syz = around.about_means(around.yz, around.y, around.z);
    const double szz = around.about_means(around.zz, around.z, around.z);
    const double off = std::max(0.0, szz - plane.rise_x * sxz - plane.rise_y * syz) / around.weight;
    const double by_chance = neighbours * off * (1 / sxx + 1 / syy);
    const double square = plane.rise_x * plane.rise_x + plane.rise_y * plane.rise_y;
    const double share = square > by_chance ? 1 - by_chance / square : 0;
    return {.x = share * plane.rise_x, .y = share * plane.rise_y};
}

} // namespace

void place_by_texture(Grid<double>& height, const Channels& all_in_focus, FocusMeasure measure,
                      const FocusWindow& window) {
    if (all_in_focus.empty() || all_in_focus[0].columns != height.columns || all_in_focus[0].rows != height.rows) {
        throw std::invalid_argument("place_by_texture: as many heights as pixels are needed");
    }
    const Grid<double> responses = focus_responses(all_in_focus, measure, window);
    const Grid<double> found = near_zero(height);
    const int reach = 2 * window.radius();
    const std::vector<double> weights(static_cast<std::size_t>(reach) + 1, 1.0);
    const double neighbours = window.pixels(2 * reach + 1, 2 * reach + 1, reach, reach);
    parallel_rows(height.columns, height.rows, [&](int from, int end) {
        std::vector<TextureColumn> textures(static_cast<std::size_t>(height.columns));
        PlaneRow around(found, weights);
        for (int row = from; row < end; ++row) {
            for (int column = 0; column < height.columns; ++column) {
                textures[static_cast<std::size_t>(column)] = texture_column(responses, window, column, row);
            }
            around.move_to(row);
            for (int column = 0; column < height.columns; ++column) {
                if (std::isfinite(found(column, row))) {
                    const Vector centre = texture_centre(textures, window, column);
                    const Vector rise = slope(around.at(column), 2 * reach + 1, neighbours);
                    height(column, row) -= rise.x * centre.x + rise.y * centre.y;
                }
            }
        }
    });
}

} // namespace vkfv::topography
