// The functions that vkfv needs of OpenImageIO. They are in a module of its own that is loaded for the first image
// other than a plain TIFF (tiff.hpp), or the first letter to be drawn: its two hundred libraries take longer to load
// than most commands to run.
#pragma once

#include "images/image_file.hpp"
#include "images/picture.hpp"

namespace vkfv::images {

// The functions of image_file.hpp and picture.hpp that the module provides, with the same names.
struct Codec {
    int (*page_count)(const std::filesystem::path& path);
    Grid<float> (*read_image)(const std::filesystem::path& path, int page);
    std::vector<Grid<float>> (*read_channels)(const std::filesystem::path& path, int page);
    ImageStatement (*image_statement)(const std::filesystem::path& path);
    StoredImage (*parse_tiff)(std::string_view bytes, const std::filesystem::path& path);
    DescribedImage (*parse_image)(std::string_view bytes, const std::filesystem::path& path);
    Grid<float> (*parse_grey)(std::string_view bytes, std::uint64_t most_pixels, const std::filesystem::path& path);
    Ink (*ink_of)(const std::string& letter, int size, const std::string& font);
    Grid<float> (*drawn)(const DrawnLetter& letter, int columns, int rows);
};

// Loads the module at the first call. RunError if it or one of its libraries is missing.
const Codec& codec();

} // namespace vkfv::images
