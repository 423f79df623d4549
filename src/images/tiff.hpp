// Plain TIFFs, the kind that vkfv writes, by libtiff: without the module of OpenImageIO (codec.hpp), which takes longer
// to load than most commands to run.
#pragma once

#include "images/image_file.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv::images {

// At least one channel, all of one size. RunError where there is no pixel, or libtiff cannot.
std::string tiff_of_floats(std::span<const Grid<float>> channels, const ImageTags& tags);
std::string tiff_of_integers(const Grid<std::uint16_t>& image, const ImageTags& tags);
std::string tiff_of_integers(const Grid<std::uint8_t>& image, const ImageTags& tags);

// One page of float32, uint16 or uint8 in one uncompressed strip, with the tags that vkfv writes and no other.
struct PlainTiff {
    int columns = 0;
    int rows = 0;
    int channels = 0;
    bool integers = false;       // uint16 or uint8, else float32
    std::string description{};   // ImageDescription; empty without one
    std::vector<float> floats{}; // all channels of a pixel, then the next pixel; the first row has the highest y
    std::vector<std::uint16_t> counts{}; // the same of integers

    // As stored, row 0 lowest.
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
    // Of four and more channels the fourth is opacity.
    bool opacity(int channel) const { return channel == 3; }
};

enum class TiffPart { header, all }; // header: without the values

// None where the file is anything else, damaged, or of more pixels than any reader takes: then OpenImageIO has to say
// what it is. Room is made for no more values than the file has.
std::optional<PlainTiff> plain_tiff(std::string_view bytes, TiffPart part);
// Throws InputError where there is no such regular file.
std::optional<PlainTiff> plain_tiff_file(const std::filesystem::path& path, TiffPart part);

// The text of a tag of the first page, as programs of other fields define their own; empty: it is no TIFF, or has none.
std::string tiff_text(std::string_view bytes, std::uint32_t tag);

} // namespace vkfv::images
