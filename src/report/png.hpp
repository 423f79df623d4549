// Pixels as the bytes of a PNG, for pictures that carry them inside.
#pragma once

#include "core/grid.hpp"
#include "report/colours.hpp"

#include <string>

namespace vkfv::report {

// Row 0 of the grid, the lowest y, becomes the PNG's last. The same pixels give the same bytes. RunError where
// libpng cannot.
std::string png_bytes(const Grid<Rgb>& pixels);

std::string base64(const std::string& bytes);

} // namespace vkfv::report
