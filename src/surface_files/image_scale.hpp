// The scale of files that state none: images, arrays, tables of numbers.
#pragma once

#include "surface_files/surface_file.hpp"

#include <filesystem>

namespace vkfv::surface {

// Throws an InputError that reports all missing parts unless both parts are given and positive.
void check_scale(const std::filesystem::path& file, const ImageScale& scale);

// Throws InputError if a scale is given for a file that states its own.
void refuse_second_scale(const std::filesystem::path& file, const ImageScale& scale);

} // namespace vkfv::surface
