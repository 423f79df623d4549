// Images of heights and of masks: one grey channel, of any format, by bands.
#include "core/error.hpp"
#include "images/exr_header.hpp"
#include "images/openimageio/functions.hpp"
#include "images/openimageio/packing.hpp"
#include "images/pnm_header.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <memory>

namespace vkfv::images::openimageio {
namespace {

// Packed pixels may be thousands of times smaller than they become; those of measured or drawn heights are not. An
// image of more pixels than this holds a byte for every so many of them, or somebody made it to fill the memory.
constexpr std::uint64_t most_packed_pixels = std::uint64_t{1} << 26; // 256 MiB of heights
constexpr std::uint64_t most_pixels_a_byte = 64;

// By the file's first bytes; for formats that have no mark of their own, by the name's ending.
std::string format_of(std::string_view bytes, const std::filesystem::path& file) {
    using namespace std::string_view_literals;
    struct Mark {
        std::string_view bytes;
        const char* format;
    };
    constexpr Mark marks[] = {{"II*\0"sv, "tiff"}, {"MM\0*"sv, "tiff"},     {"II+\0"sv, "tiff"},
                              {"MM\0+"sv, "tiff"}, {"\x89PNG"sv, "png"},    {"\xff\xd8\xff"sv, "jpeg"},
                              {"BM"sv, "bmp"},     {"#?RADIANCE"sv, "hdr"}, {"#?RGBE"sv, "hdr"},
                              {"P1"sv, "pnm"},     {"P2"sv, "pnm"},         {"P3"sv, "pnm"},
                              {"P4"sv, "pnm"},     {"P5"sv, "pnm"},         {"P6"sv, "pnm"},
                              {"Pf"sv, "pnm"},     {"PF"sv, "pnm"},         {"\x76\x2f\x31\x01"sv, "openexr"}};
    for (const Mark& mark : marks) {
        if (bytes.starts_with(mark.bytes)) {
            return mark.format;
        }
    }
    std::string ending = file.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
    return ending.empty() ? ending : ending.substr(1);
}

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& found, const std::string& expected,
                       const std::string& remedy) {
    refuse_file(file, "image", found, expected, remedy);
}

struct Channels {
    int count = 0;
    int grey = 0; // the first that is not opacity
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
    const bool opacity = spec.alpha_channel >= 0;
    const int others = spec.nchannels - (opacity ? 1 : 0);
    if (others != 1 && others != 3) {
        fail(file, fmt::format("{} channels", spec.nchannels), "one grey channel", "Convert the image to grey.");
    }
    return {.count = spec.nchannels, .grey = spec.alpha_channel == 0 ? 1 : 0, .colour = others == 3};
}

bool read_rows(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, int channels, int first, int end, float* band) {
    const int top = spec.y + first, bottom = spec.y + end;
    const bool read = spec.tile_width > 0
                          ? input.read_tiles(0, 0, spec.x, spec.x + spec.width, top, bottom, spec.z, spec.z + 1, 0,
                                             channels, OIIO::TypeDesc::FLOAT, band)
                          : input.read_scanlines(0, 0, top, bottom, spec.z, 0, channels, OIIO::TypeDesc::FLOAT, band);
    // Rows that the file does not have may come as zeros, with an error that only this tells.
    return read && !input.has_error();
}

// Rows are read in bands that exist in the file before room is made for the next: a header that lies about the size
// ends at the first band that is missing. From the top.
std::vector<float> read_heights(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, const Channels& channels,
                                const std::filesystem::path& file) {
    constexpr int rows_at_once = 64;
    const std::size_t width = static_cast<std::size_t>(spec.width);
    const int band_rows = std::min(spec.tile_height > 0 ? spec.tile_height : rows_at_once, spec.height);
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
            heights.push_back(values[0]);
        }
    }
    return heights;
}

} // namespace

Grid<float> parse_grey(std::string_view bytes, std::uint64_t most_pixels, const std::filesystem::path& file) {
    if (looks_like_exr(bytes)) {
        check_exr_attributes(bytes, file);
    }
    if (looks_like_pnm(bytes)) {
        check_pnm(bytes, file);
    }
    const std::string format = format_of(bytes, file);
    OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size()); // outlives the input that reads it
    // By name: every other reader that OpenImageIO has would be offered the bytes otherwise.
    const auto input = format.empty() ? nullptr : OIIO::ImageInput::create(format);
    (void)OIIO::geterror();
    if (!input || !input->supports("ioproxy")) {
        fail(file, "a file of unknown kind", "an image", "Convert it to PNG, TIFF or OpenEXR.");
    }
    OIIO::ImageSpec spec;
    OIIO::ImageSpec wish;
    wish["oiio:UnassociatedAlpha"] = 1; // grey values must not be multiplied by opacity
    if (!input->set_ioproxy(&memory) || !input->open(file.string(), spec, wish) || input->has_error()) {
        fail(file, input->geterror(), "an image that OpenImageIO reads", "Convert it to PNG, TIFF or OpenEXR.");
    }
    const Channels channels = check(spec, bytes.size(), most_pixels, file);
    const std::vector<float> from_top = read_heights(*input, spec, channels, file);
    Grid<float> grid(spec.width, spec.height);
    const auto width = static_cast<std::ptrdiff_t>(spec.width);
    for (int row = 0; row < spec.height; ++row) {
        const auto first = from_top.begin() + width * (spec.height - 1 - row);
        std::copy(first, first + width, grid.values.begin() + width * row);
    }
    return grid;
}

} // namespace vkfv::images::openimageio
