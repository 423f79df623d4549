#include "specimen/files.hpp"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vkfv::specimen {

Grid<float> read_image(const std::filesystem::path& file, const SourceLocation& mention) {
    const auto fail = [&](const std::string& found, const std::string& expected, const std::string& remedy) {
        throw InputError({{file, 0, 0, {}}, "image", found, expected, remedy});
    };
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) {
        throw InputError({mention, "specimen.file", file.string(), "a file that can be read",
                          "Correct the path; it is relative to the configuration file."});
    }
    OIIO::ImageSpec wish;
    wish["oiio:UnassociatedAlpha"] = 1; // grey values must not be multiplied by alpha
    const auto input = OIIO::ImageInput::open(file.string(), &wish);
    if (!input) {
        fail(OIIO::geterror(), "an image that OpenImageIO reads", "Convert it to PNG, TIFF or OpenEXR.");
    }
    const OIIO::ImageSpec& spec = input->spec();
    if (spec.width < 2 || spec.height < 2 || spec.depth > 1 ||
        static_cast<std::uint64_t>(spec.width) * static_cast<std::uint64_t>(spec.height) >
            largest_point_count) {
        fail(fmt::format("{} x {} x {} pixels", spec.width, spec.height, spec.depth),
             fmt::format("a flat image of at least 2 x 2 and at most {} pixels", largest_point_count),
             "Crop or scale the image.");
    }
    const int channels = spec.nchannels;
    const bool alpha = spec.alpha_channel >= 0;
    const int grey_channels = channels - (alpha ? 1 : 0);
    if (grey_channels != 1 && grey_channels != 3) {
        fail(fmt::format("{} channels", channels), "one grey channel", "Convert the image to grey.");
    }

    // Rows are read in bands that exist in the file before the next is allocated: a header that lies about
    // the size ends at the first band that is missing.
    const std::size_t width = static_cast<std::size_t>(spec.width);
    const int band_rows = spec.tile_height > 0 ? spec.tile_height : 64;
    std::vector<float> band;
    std::vector<float> from_top;
    for (int row = 0; row < spec.height; row += band_rows) {
        const int end = std::min(row + band_rows, spec.height);
        band.resize(width * static_cast<std::size_t>(end - row) * static_cast<std::size_t>(channels));
        const int top = spec.y + row;
        const int bottom = spec.y + end;
        const bool read = spec.tile_width > 0
                              ? input->read_tiles(0, 0, spec.x, spec.x + spec.width, top, bottom, spec.z,
                                                  spec.z + 1, 0, channels, OIIO::TypeDesc::FLOAT, band.data())
                              : input->read_scanlines(0, 0, top, bottom, spec.z, 0, channels,
                                                      OIIO::TypeDesc::FLOAT, band.data());
        if (!read) {
            fail(fmt::format("rows {} to {} from the top: {}", row, end - 1, input->geterror()),
                 fmt::format("{} x {} pixels", spec.width, spec.height),
                 "Save the image anew; it is damaged.");
        }
        for (std::size_t pixel = 0; pixel < band.size(); pixel += static_cast<std::size_t>(channels)) {
            const float* values = band.data() + pixel;
            const std::size_t index = from_top.size();
            const auto place = [&] {
                return fmt::format("pixel ({}, {}) from the top left", index % width, index / width);
            };
            const int grey = spec.alpha_channel == 0 ? 1 : 0;
            if (!std::isfinite(values[grey])) {
                fail(fmt::format("{} in {}", values[grey], place()), "finite values",
                     "Fill in what is missing.");
            }
            if (grey_channels == 3 &&
                (values[grey] != values[grey + 1] || values[grey] != values[grey + 2])) {
                fail(fmt::format("colour in {}", place()), "grey values", "Convert the image to grey.");
            }
            from_top.push_back(values[grey]);
        }
    }
    Grid<float> grid(spec.width, spec.height);
    for (int row = 0; row < spec.height; ++row) {
        const auto first = from_top.begin() + static_cast<std::ptrdiff_t>(width) * (spec.height - 1 - row);
        std::copy(first, first + spec.width, grid.values.begin() + static_cast<std::ptrdiff_t>(width) * row);
    }
    return grid;
}

} // namespace vkfv::specimen
