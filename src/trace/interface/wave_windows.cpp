#include "trace/interface/wave_windows.hpp"

#include "core/mathematics/fourier.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace vkfv::trace {

namespace {

using waves::f64::TileRamp;

// Widths in parts of pixels; the finest frequency has at least two parts a period. margin_parts: beside a window;
// fade_parts: half the width over which windows fade into each other.
constexpr double margin_parts = 48;
constexpr double fade_parts = 16;

struct Line {
    int first = 0;
    int count = 0;
    TileRamp ramp{};
};

// The windows along one side of `pixels` pixels.
std::vector<Line> lines_of(int tiles, int pixels, int parts) {
    if (tiles == 1) {
        return {{.first = 0, .count = pixels, .ramp = {.from = 0, .width = 0, .fade = 1, .neighbours = 0}}};
    }
    const int windows = tiles - 1;
    const double width = static_cast<double>(pixels) / windows;
    const int margin = static_cast<int>(std::ceil(margin_parts / parts));
    int count = static_cast<int>(std::ceil(width)) + 1 + 2 * margin;
    while (count < pixels && convenient_length(count) != count) {
        ++count;
    }
    count = std::min(count, pixels);
    std::vector<Line> lines;
    for (int k = 0; k < windows; ++k) {
        const double from = k * width;
        const double middle = from + 0.5 * width;
        const int first = std::clamp(static_cast<int>(std::lround(middle - 0.5 * count)), 0, pixels - count);
        const std::uint32_t neighbours = (k > 0 ? 1u : 0u) + (k + 1 < windows ? 2u : 0u);
        lines.push_back({.first = first,
                         .count = count,
                         .ramp = {.from = from,
                                  .width = width,
                                  .fade = std::min(fade_parts / parts, 0.5 * width),
                                  .neighbours = neighbours}});
    }
    return lines;
}

} // namespace

std::vector<WaveWindow> wave_windows(int tiles, ImageSize pixels, int parts) {
    const auto columns = lines_of(tiles, pixels.columns, parts);
    const auto rows = lines_of(tiles, pixels.rows, parts);
    std::vector<WaveWindow> windows;
    for (int j = 0; j < static_cast<int>(rows.size()); ++j) {
        for (int i = 0; i < static_cast<int>(columns.size()); ++i) {
            const Line& along = columns[static_cast<std::size_t>(i)];
            const Line& up = rows[static_cast<std::size_t>(j)];
            WaveWindow window{.column = along.first,
                              .row = up.first,
                              .size = {along.count, up.count},
                              .filters = tiles == 1 ? 1 : 4,
                              .tiles = {},
                              .along = along.ramp,
                              .up = up.ramp};
            const int corner = j * tiles + i;
            if (tiles > 1) {
                window.tiles = {corner, corner + 1, corner + tiles, corner + tiles + 1};
            }
            windows.push_back(window);
        }
    }
    return windows;
}

std::array<double, 4> weights_at(const WaveWindow& window, int column, int row) {
    const auto along = waves::f64::tile_weights(window.along, column + 0.5);
    const auto up = waves::f64::tile_weights(window.up, row + 0.5);
    return {along.x * up.x, along.y * up.x, along.x * up.y, along.y * up.y};
}

} // namespace vkfv::trace
