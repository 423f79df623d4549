// Pixels as the bytes of a PNG, for documents that embed pictures.
#pragma once

#include "core/mathematics/grid.hpp"
#include "report/colours.hpp"

#include <cstdint>
#include <string>

namespace vkfv::report {

// The PNG of coloured pixels. Row 0 of the grid, the lowest y, becomes the PNG's last. The same pixels give the same
// bytes. RunError if libpng fails.
std::string png_bytes(const Grid<Rgb>& pixels);

// The PNG of grey values in 0 ... 255, with the same order of rows.
std::string grey_png_bytes(const Grid<std::uint8_t>& pixels);

std::string base64(const std::string& bytes);

} // namespace vkfv::report
