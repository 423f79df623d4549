// Images as files: plain TIFFs, as vkfv writes them, by libtiff, and all others by OpenImageIO.
//
// Row order: in memory row 0 has the lowest y; in a file the first row has the highest y, so that every
// viewer shows the specimen as seen from +z, x to the right and y up. Writers flip the rows, readers flip
// them back.
//
// Images are encoded in memory, for core/files/file.hpp to write; the bytes depend on the arguments alone: no
// compression, no clock, no version. Readers throw InputError where the file is at fault, also where it could not be
// read whole.
#pragma once

#include "core/mathematics/grid.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv::images {

// The properties of the pixels that a TIFF states besides their values. The pitches are written as pixels per cm, which
// Fiji converts to micrometres for pitches below 10 um.
struct ImageTags {
    double pitch_x = 0;      // mm in the object plane; 0 omits the resolution tags
    double pitch_y = 0;      // mm in the object plane
    std::string description; // ImageDescription, ASCII
};

// The bytes of a TIFF file of one page, float32.
std::string tiff_bytes(const Grid<float>& image, const ImageTags& tags = {});
// The bytes of a TIFF file of one page, float32, with a channel for each image; all images have one size.
std::string tiff_bytes(const std::vector<Grid<float>>& channels, const ImageTags& tags = {});
// The bytes of a TIFF file of one page, uint16 or uint8.
std::string tiff_bytes(const Grid<std::uint16_t>& image, const ImageTags& tags = {});
std::string tiff_bytes(const Grid<std::uint8_t>& image, const ImageTags& tags = {});

// The number of pages (TIFF directories) of an image file.
int page_count(const std::filesystem::path& path);

// Reads one page of a single-channel image in any format that OpenImageIO supports; integers keep their stored value
// (they are not scaled to 0..1). `page` counts from 0.
Grid<float> read_image(const std::filesystem::path& path, int page = 0);

// Reads one page of a grey or colour image, a grid for each channel; an alpha channel is left out.
std::vector<Grid<float>> read_channels(const std::filesystem::path& path, int page = 0);

// The properties of an image file's first page: its size, description and date, and its pixels per unit of length.
struct ImageStatement {
    int columns = 0;
    int rows = 0;
    int channels = 0;            // without opacity
    std::string description{};   // ImageDescription; empty if missing
    double columns_per_unit = 0; // from the resolution tags of a TIFF; 0: none
    double rows_per_unit = 0;    // from the resolution tags of a TIFF; 0: none
    enum class Unit { none, inch, centimetre };
    Unit unit = Unit::none; // unit of columns_per_unit and rows_per_unit
    std::string date{};     // time of recording, "2026:01:31 12:00:00" in local time; empty if not stated
};
ImageStatement image_statement(const std::filesystem::path& path);

struct StoredImage {
    Grid<float> values;      // as stored
    std::string description; // ImageDescription; empty if missing
};

// Reads the first page of a single-channel TIFF file in memory; `path` names it in messages.
StoredImage parse_tiff(std::string_view bytes, const std::filesystem::path& path);

struct DescribedImage {
    Grid<double> values;         // as stored
    std::string description;     // ImageDescription; empty if missing
    double columns_per_unit = 0; // from the resolution tags of a TIFF that ImageJ wrote; 0: none
    double rows_per_unit = 0;    // from the resolution tags of a TIFF that ImageJ wrote; 0: none
};

// Reads the first page of a single-channel file in memory; `path` names it in messages.
DescribedImage parse_image(std::string_view bytes, const std::filesystem::path& path);

// Reads heights or a mask: one grey channel of any format, the file in memory, without opacity. The image has at least
// 2 x 2 pixels and at most `most_pixels`, with finite values. Rows are read in bands, so that a header with a false
// size cannot exhaust the memory.
Grid<float> parse_grey(std::string_view bytes, std::uint64_t most_pixels, const std::filesystem::path& path);

} // namespace vkfv::images
