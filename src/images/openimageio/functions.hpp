// The functions of the OpenImageIO module; images/codec.hpp states its purpose.
#pragma once

#include "images/codec.hpp"

namespace vkfv::images::openimageio {

int page_count(const std::filesystem::path& path);
Grid<float> read_image(const std::filesystem::path& path, int page);
std::vector<Grid<float>> read_channels(const std::filesystem::path& path, int page);
ImageStatement image_statement(const std::filesystem::path& path);
StoredImage parse_tiff(std::string_view bytes, const std::filesystem::path& path);
DescribedImage parse_image(std::string_view bytes, const std::filesystem::path& path);
Grid<float> parse_grey(std::string_view bytes, std::uint64_t most_pixels, const std::filesystem::path& path);
Ink ink_of(const std::string& letter, int size, const std::string& font);
Grid<float> drawn(const DrawnLetter& letter, int columns, int rows);

} // namespace vkfv::images::openimageio
