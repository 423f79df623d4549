// The scale of files that state none themselves: images, arrays, tables of numbers.
#pragma once

#include "surface_files/surface_file.hpp"

#include <filesystem>

namespace vkfv::surface {

// Both parts are there and positive, or an InputError tells of all that is missing.
void check_scale(const std::filesystem::path& file, const ImageScale& scale);

// InputError where a scale is given: the file states its own.
void refuse_second_scale(const std::filesystem::path& file, const ImageScale& scale);

} // namespace vkfv::surface
