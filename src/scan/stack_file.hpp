// All images of a stack in one file, for programs that show image stacks.
#pragma once

#include "scan/store.hpp"

#include <cstdint>
#include <string_view>

namespace vkfv::scan {

inline constexpr std::string_view stack_file_name = "images.tif";

// Writes the file among the stack's results from the single images, one after the other: a calibrated z-stack of ImageJ
// (images/tiff_stack.hpp), the lowest height first, with the pixels of the single images. Throws InputError where an
// image is missing or damaged, RunError if the disk fails.
void write_stack_file(ImageStore& store);

// Upper bound of the file's size in bytes.
std::uint64_t stack_file_bytes(std::uint64_t images, std::uint64_t pixels, PixelType type);

} // namespace vkfv::scan
