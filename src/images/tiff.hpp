// Reads and writes plain TIFFs, the kind that vkfv writes, by libtiff: without the module of OpenImageIO (codec.hpp),
// which takes longer to load than most commands to run.
#pragma once

#include "images/image_file.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv::images {

// The bytes of a TIFF of at least one channel, all of one size. RunError if there is no pixel, or if libtiff fails.
std::string tiff_of_floats(std::span<const Grid<float>> channels, const ImageTags& tags);
std::string tiff_of_integers(const Grid<std::uint16_t>& image, const ImageTags& tags);
std::string tiff_of_integers(const Grid<std::uint8_t>& image, const ImageTags& tags);

// A plain TIFF: one page of float32, uint16 or uint8 in one uncompressed strip, with only tags that vkfv writes.
struct PlainTiff {
    int columns = 0;
    int rows = 0;
    int channels = 0;
    bool integers = false;               // true: uint16 or uint8; false: float32
    std::string description{};           // ImageDescription; empty if missing
    std::vector<float> floats{};         // pixel by pixel, all channels of each; the first row has the highest y
    std::vector<std::uint16_t> counts{}; // integer values in the same order

    // A channel as stored, row 0 lowest.
    template <class Value>
    Grid<Value> channel(int index) const {
        Grid<Value> grid(columns, rows);
        for (int row = 0; row < rows; ++row) {
            for (int column = 0; column < columns; ++column) {
                const std::size_t place = grid.index(column, rows - 1 - row) * static_cast<std::size_t>(channels) +
                                          static_cast<std::size_t>(index);
                grid(column, row) = integers ? static_cast<Value>(counts[place]) : static_cast<Value>(floats[place]);
            }
        }
        return grid;
    }
    // True for the fourth of four and more channels.
    bool opacity(int channel) const { return channel == 3; }
};

enum class TiffPart { header, all }; // header: without the values

// Parses a plain TIFF. None if the file is anything else, damaged, or larger than any reader accepts: OpenImageIO then
// identifies it. No more values are allocated than the file contains.
std::optional<PlainTiff> plain_tiff(std::string_view bytes, TiffPart part);
// Reads a plain TIFF from a file. Throws InputError if there is no such regular file.
std::optional<PlainTiff> plain_tiff_file(const std::filesystem::path& path, TiffPart part);

// The text of a tag of the first page, such as other programs define for themselves; empty if the file is no TIFF, or
// lacks the tag.
std::string tiff_text(std::string_view bytes, std::uint32_t tag);

} // namespace vkfv::images
