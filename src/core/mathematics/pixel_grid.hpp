// Regular grids of points, for pixels and heights.
#pragma once

#include <cstddef>
#include <string>

namespace vkfv {

// The size of an image in pixels.
struct ImageSize {
    int columns = 0;
    int rows = 0;

    static constexpr ImageSize square(int side) { return {side, side}; }
    constexpr std::size_t count() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
    constexpr bool operator==(const ImageSize&) const = default;
};

// The size as the key detector.pixels has it: "64", "[64, 48]".
inline std::string text_of(ImageSize pixels) {
    return pixels.columns == pixels.rows
               ? std::to_string(pixels.columns)
               : "[" + std::to_string(pixels.columns) + ", " + std::to_string(pixels.rows) + "]";
}

// A regular grid: column i and row j are at (x0 + i * pitch_x, y0 + j * pitch_y), in mm.
struct PixelGrid {
    int columns = 0;
    int rows = 0;
    double x0 = 0;
    double y0 = 0;
    double pitch_x = 0;
    double pitch_y = 0;

    // A grid whose middle is the origin, where the optical axis meets the detector.
    static PixelGrid centred(int columns, int rows, double pitch_x, double pitch_y) {
        return {.columns = columns,
                .rows = rows,
                .x0 = -0.5 * (columns - 1) * pitch_x,
                .y0 = -0.5 * (rows - 1) * pitch_y,
                .pitch_x = pitch_x,
                .pitch_y = pitch_y};
    }
    static PixelGrid centred(int columns, int rows, double pitch) { return centred(columns, rows, pitch, pitch); }
    static PixelGrid centred(ImageSize size, double pitch) { return centred(size.columns, size.rows, pitch); }
};

} // namespace vkfv
