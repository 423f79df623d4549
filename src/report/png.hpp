// Pixels as the bytes of a PNG, for pictures that carry them inside.
#pragma once

#include "core/mathematics/grid.hpp"
#include "report/colours.hpp"

#include <cstdint>
#include <string>

namespace vkfv::report {

// Row 0 of the grid, the lowest y, becomes the PNG's last. The same pixels give the same bytes. RunError where
// libpng cannot.
std::string png_bytes(const Grid<Rgb>& pixels);

// The same of grey values in 0 ... 255.
std::string grey_png_bytes(const Grid<std::uint8_t>& pixels);

std::string base64(const std::string& bytes);

} // namespace vkfv::report
