// Pictures: PNG by libpng, and letters as pixels by OpenImageIO.
#pragma once

#include "core/mathematics/grid.hpp"

#include <cstdint>
#include <span>
#include <string>

namespace vkfv::images {

// Three bytes a pixel, the first row on top. The same pixels give the same bytes. RunError where libpng cannot.
std::string png_bytes(int columns, int rows, std::span<const std::uint8_t> rgb);
// One byte a pixel, likewise.
std::string grey_png_bytes(int columns, int rows, std::span<const std::uint8_t> grey);

// The pixels that a letter covers, its origin on the baseline, y down; ends excluded.
struct Ink {
    int left = 0;
    int right = 0;
    int top = 0;
    int bottom = 0;
    std::string reason{}; // where it covers none

    bool any() const { return right > left; }
    int width() const { return right - left; }
};

// font: a name that OpenImageIO finds, or a file; size in pixels.
Ink ink_of(const std::string& letter, int size, const std::string& font);

struct DrawnLetter {
    std::string letter;
    int size = 0;
    std::string font;
    int x = 0; // of its origin
    int baseline = 0;
};

// 1 where it covers a pixel, row 0 lowest. RunError where OpenImageIO cannot.
Grid<float> drawn(const DrawnLetter& letter, int columns, int rows);

} // namespace vkfv::images
