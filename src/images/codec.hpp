// What vkfv asks of OpenImageIO. It stands in a module of its own that is loaded when the first image is read, written
// or drawn: the two hundred libraries behind it take longer to load than most commands to run.
#pragma once

#include "images/image_file.hpp"
#include "images/picture.hpp"

#include <span>

namespace vkfv::images {

// Functions of image_file.hpp and picture.hpp, by their names.
struct Codec {
    std::string (*tiff_of_floats)(std::span<const Grid<float>> channels, const ImageTags& tags);
    std::string (*tiff_of_integers)(const Grid<std::uint16_t>& image, const ImageTags& tags);
    int (*page_count)(const std::filesystem::path& path);
    Grid<float> (*read_image)(const std::filesystem::path& path, int page);
    std::vector<Grid<float>> (*read_channels)(const std::filesystem::path& path, int page);
    std::string (*image_description)(const std::filesystem::path& path);
    StoredImage (*parse_tiff)(std::string_view bytes, const std::filesystem::path& path);
    DescribedImage (*parse_image)(std::string_view bytes, ImageFormat format, const std::filesystem::path& path);
    Grid<float> (*parse_grey)(std::string_view bytes, std::uint64_t most_pixels, const std::filesystem::path& path);
    std::string (*png)(int columns, int rows, std::span<const std::uint8_t> rgb);
    Ink (*ink_of)(const std::string& letter, int size, const std::string& font);
    Grid<float> (*drawn)(const DrawnLetter& letter, int columns, int rows);
};

// Loads the module, once. RunError where it or a library of it is missing.
const Codec& codec();

} // namespace vkfv::images
