// Images of heights and of masks: one grey channel, of any format, read by bands.
#include "core/messages/error.hpp"
#include "images/openimageio/functions.hpp"
#include "images/openimageio/orientation.hpp"
#include "images/openimageio/packing.hpp"
#include "images/openimageio/source.hpp"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vkfv::images::openimageio {
namespace {

// The limits of packed pixels, which may be thousands of times smaller than unpacked. Measured or drawn heights are not
// packed that well: an image of more pixels than this has at least a byte in the file for so many of them; others are
// made to exhaust the memory.
constexpr std::uint64_t most_packed_pixels = std::uint64_t{1} << 26; // 256 MiB of heights
constexpr std::uint64_t most_pixels_a_byte = 64;

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& found, const std::string& expected,
                       const std::string& remedy) {
    refuse_file(file, "image", found, expected, remedy);
}

struct Channels {
    int count = 0;
    int grey = 0; // first channel that is not opacity
    bool colour = false;
};

Channels check(const OIIO::ImageSpec& spec, std::uint64_t file_bytes, std::uint64_t most_pixels,
               const std::filesystem::path& file) {
    const auto pixels =
        static_cast<std::uint64_t>(std::max(spec.width, 0)) * static_cast<std::uint64_t>(std::max(spec.height, 0));
    if (spec.width < 2 || spec.height < 2 || spec.depth > 1 || pixels > most_pixels) {
        fail(file, fmt::format("{} x {} x {} pixels", spec.width, spec.height, spec.depth),
             fmt::format("a flat image of at least 2 x 2 and at most {} pixels", most_pixels),
             "Crop or scale the image.");
    }
    if (pixels > most_packed_pixels && pixels / most_pixels_a_byte > file_bytes) {
        fail(file, fmt::format("{} x {} pixels in {} bytes", spec.width, spec.height, file_bytes),
             fmt::format("beyond {} pixels a byte of the file for every {} of them", most_packed_pixels,
                         most_pixels_a_byte),
             "Crop or scale the image, or save it without compression if it is really so large.");
    }
    if (!packing_is_possible(spec, static_cast<double>(file_bytes))) {
        fail(file,
             fmt::format("{} x {} pixels, {} x {} in a tile, in {} bytes", spec.width, spec.height, spec.tile_width,
                         spec.tile_height, file_bytes),
             "no more than packing can do", "The file is truncated or damaged: write or copy it anew.");
    }
    const int opacity = opacity_channel(spec);
    const int others = spec.nchannels - (opacity >= 0 ? 1 : 0);
    if (others != 1 && others != 3) {
        fail(file, fmt::format("{} channels", spec.nchannels), "one grey channel", "Convert the image to grey.");
    }
    return {.count = spec.nchannels, .grey = opacity == 0 ? 1 : 0, .colour = others == 3};
}

bool read_rows(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, int channels, int first, int end, float* band) {
    const int top = spec.y + first, bottom = spec.y + end;
    const bool read = spec.tile_width > 0
                          ? input.read_tiles(0, 0, spec.x, spec.x + spec.width, top, bottom, spec.z, spec.z + 1, 0,
                                             channels, OIIO::TypeDesc::FLOAT, band)
                          : input.read_scanlines(0, 0, top, bottom, spec.z, 0, channels, OIIO::TypeDesc::FLOAT, band);
    // Rows missing in the file may be returned as zeros, with an error that only has_error() reports.
    return read && !input.has_error();
}

// Reads rows from the top in bands; memory for a band is allocated only after the previous one was found in the file,
// so a header with a false size fails at the first missing band.
std::vector<float> read_heights(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, const Channels& channels,
                                const std::filesystem::path& file) {
    constexpr int rows_at_once = 64;
    const std::size_t width = static_cast<std::size_t>(spec.width);
    const int band_rows = whole_strips_only(input, spec)
                              ? spec.height
                              : std::min(spec.tile_height > 0 ? spec.tile_height : rows_at_once, spec.height);
    const bool from_white = counts_from_white(input, spec);
    std::vector<float> band;
    std::vector<float> heights;
    for (int row = 0; row < spec.height; row += std::min(band_rows, spec.height - row)) {
        const int end = row + std::min(band_rows, spec.height - row);
        band.resize(width * static_cast<std::size_t>(end - row) * static_cast<std::size_t>(channels.count));
        if (!read_rows(input, spec, channels.count, row, end, band.data())) {
            fail(file, fmt::format("rows {} to {} from the top: {}", row, end - 1, input.geterror()),
                 fmt::format("{} x {} pixels", spec.width, spec.height),
                 "Save or copy the image anew; it is damaged or truncated.");
        }
        for (std::size_t pixel = 0; pixel < band.size(); pixel += static_cast<std::size_t>(channels.count)) {
            const float* values = band.data() + pixel + channels.grey;
            const auto place = [&] {
                return fmt::format("pixel ({}, {}) from the top left", heights.size() % width, heights.size() / width);
            };
            if (!std::isfinite(values[0])) {
                fail(file, fmt::format("{} in {}", values[0], place()), "finite values", "Fill in what is missing.");
            }
            if (channels.colour && (values[0] != values[1] || values[0] != values[2])) {
                fail(file, fmt::format("colour in {}", place()), "grey values", "Convert the image to grey.");
            }
            heights.push_back(from_white ? 1 - values[0] : values[0]);
        }
    }
    return heights;
}

} // namespace

Grid<float> parse_grey(std::string_view bytes, std::uint64_t most_pixels, const std::filesystem::path& file) {
    const OpenImage image = open_image(bytes, file);
    const OIIO::ImageSpec spec = image.input->spec();
    const Channels channels = check(spec, image.bytes, most_pixels, file);
    refuse_lost_values(*image.input, spec, file);
    return upright<float>(read_heights(*image.input, spec, channels, file), spec.width, spec.height,
                          orientation_of(spec));
}

} // namespace vkfv::images::openimageio
