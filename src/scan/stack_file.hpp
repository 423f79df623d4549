// All images of a stack in one file, for programs that show image stacks.
#pragma once

#include "scan/store.hpp"

#include <cstdint>
#include <string_view>

namespace vkfv::scan {

inline constexpr std::string_view stack_file_name = "images.tif";

// Writes it among the stack's results from the single images, one after the other: a calibrated z-stack of ImageJ
// (images/tiff_stack.hpp), the lowest height first, pixels as the single images have them. Throws InputError where an
// image is missing or not whole, RunError if the disk fails.
void write_stack_file(ImageStore& store);

// What it takes on the disk.
std::uint64_t stack_file_bytes(std::uint64_t images, std::uint64_t pixels, PixelType type);

} // namespace vkfv::scan
