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

// What a TIFF says of its pixels beside their values.
struct ImageTags {
    double pitch_x = 0;      // mm in the object plane; 0 leaves out the resolution tags. Written in pixels per cm,
    double pitch_y = 0;      // which Fiji turns into micrometres for pitches below 10 um
    std::string description; // ImageDescription: ASCII
};

// A TIFF file: float32, one page.
std::string tiff_bytes(const Grid<float>& image, const ImageTags& tags = {});
// The same with several channels a pixel, as many as there are images; all of one size.
std::string tiff_bytes(const std::vector<Grid<float>>& channels, const ImageTags& tags = {});
// uint16 or uint8, one page.
std::string tiff_bytes(const Grid<std::uint16_t>& image, const ImageTags& tags = {});
std::string tiff_bytes(const Grid<std::uint8_t>& image, const ImageTags& tags = {});

// Number of pages (TIFF directories) of an image file.
int page_count(const std::filesystem::path& path);

// One page of a single-channel image in any format that OpenImageIO reads; integers keep their stored value
// (they are not scaled to 0..1). `page` counts from 0.
Grid<float> read_image(const std::filesystem::path& path, int page = 0);

// The same of grey or colour, a grid a channel; an alpha channel is left out.
std::vector<Grid<float>> read_channels(const std::filesystem::path& path, int page = 0);

// The size of an image file's first page, its description, its date, and how many of its pixels make a unit of length.
struct ImageStatement {
    int columns = 0;
    int rows = 0;
    int channels = 0;            // without opacity
    std::string description{};   // ImageDescription; empty without one
    double columns_per_unit = 0; // resolution tags of a TIFF; 0: none
    double rows_per_unit = 0;    // likewise
    enum class Unit { none, inch, centimetre };
    Unit unit = Unit::none; // theirs
    std::string date{};     // when it was taken, "2026:01:31 12:00:00" in local time; empty: it is not stated
};
ImageStatement image_statement(const std::filesystem::path& path);

struct StoredImage {
    Grid<float> values;      // as stored
    std::string description; // ImageDescription; empty without one
};

// The first page of a whole single-channel TIFF file in memory; `path` names it in messages.
StoredImage parse_tiff(std::string_view bytes, const std::filesystem::path& path);

struct DescribedImage {
    Grid<double> values;         // as stored
    std::string description;     // ImageDescription; empty without one
    double columns_per_unit = 0; // resolution tags of a TIFF that ImageJ wrote; 0: none
    double rows_per_unit = 0;    // likewise
};

// The first page of a whole single-channel file in memory; `path` names it in messages.
DescribedImage parse_image(std::string_view bytes, const std::filesystem::path& path);

// Heights or a mask: one grey channel of any format, whole in memory, without its opacity. At least 2 x 2 pixels and at
// most so many; finite values. Rows are read in bands, so that a header which lies about the size fills no memory.
Grid<float> parse_grey(std::string_view bytes, std::uint64_t most_pixels, const std::filesystem::path& path);

} // namespace vkfv::images
