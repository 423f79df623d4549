// Pictures: PNG by libpng, and letters as pixels by OpenImageIO.
#pragma once

#include "core/mathematics/grid.hpp"

#include <cstdint>
#include <span>
#include <string>

namespace vkfv::images {

// The bytes of a colour PNG from three bytes a pixel, the first row on top. Equal pixels give equal bytes. RunError if
// libpng fails.
std::string png_bytes(int columns, int rows, std::span<const std::uint8_t> rgb);
// The bytes of a grey PNG from one byte a pixel, the first row on top. Equal pixels give equal bytes. RunError if
// libpng fails.
std::string grey_png_bytes(int columns, int rows, std::span<const std::uint8_t> grey);

// The bounding box of the pixels that a letter covers, with the letter's origin on the baseline, y down; ends excluded.
struct Ink {
    int left = 0;
    int right = 0;
    int top = 0;
    int bottom = 0;
    std::string reason{}; // reason why no pixel is covered

    bool any() const { return right > left; }
    int width() const { return right - left; }
};

// The bounding box of a letter. font: a name that OpenImageIO finds, or a file; size in pixels.
Ink ink_of(const std::string& letter, int size, const std::string& font);

struct DrawnLetter {
    std::string letter;
    int size = 0;
    std::string font;
    int x = 0; // position of the letter's origin
    int baseline = 0;
};

// An image of a letter: 1 where it covers a pixel, row 0 lowest. RunError if OpenImageIO fails.
Grid<float> drawn(const DrawnLetter& letter, int columns, int rows);

} // namespace vkfv::images
