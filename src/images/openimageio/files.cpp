// Image files of all kinds: implements functions of images/image_file.hpp.
#include "core/messages/error.hpp"
#include "images/openimageio/functions.hpp"
#include "images/openimageio/orientation.hpp"
#include "images/openimageio/packing.hpp"
#include "images/openimageio/source.hpp"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <type_traits>
#include <vector>

namespace vkfv::images::openimageio {
namespace {

template <class Value>
constexpr OIIO::TypeDesc type_of();
template <>
constexpr OIIO::TypeDesc type_of<std::uint8_t>() {
    return OIIO::TypeDesc::UINT8;
}
template <>
constexpr OIIO::TypeDesc type_of<std::int8_t>() {
    return OIIO::TypeDesc::INT8;
}
template <>
constexpr OIIO::TypeDesc type_of<std::uint16_t>() {
    return OIIO::TypeDesc::UINT16;
}
template <>
constexpr OIIO::TypeDesc type_of<std::int16_t>() {
    return OIIO::TypeDesc::INT16;
}
template <>
constexpr OIIO::TypeDesc type_of<std::uint32_t>() {
    return OIIO::TypeDesc::UINT32;
}
template <>
constexpr OIIO::TypeDesc type_of<std::int32_t>() {
    return OIIO::TypeDesc::INT32;
}
template <>
constexpr OIIO::TypeDesc type_of<float>() {
    return OIIO::TypeDesc::FLOAT;
}
template <>
constexpr OIIO::TypeDesc type_of<double>() {
    return OIIO::TypeDesc::DOUBLE;
}

// Limits of the size that a header may claim before a pixel is read: an image of more than freely_given_bytes must not
// exceed largest_packing times the file's own size.
constexpr double largest_pixel_count = 1 << 28;
constexpr double freely_given_bytes = 1 << 28;
constexpr double largest_packing = 64;

void check_size(const OpenImage& image, const OIIO::ImageSpec& spec, const std::filesystem::path& path) {
    const double pixels = static_cast<double>(spec.width) * spec.height;
    const auto file_bytes = static_cast<double>(image.bytes);
    const double bytes = pixels * spec.nchannels * static_cast<double>(spec.format.size());
    if (!(spec.width > 0 && spec.height > 0 && pixels <= largest_pixel_count &&
          bytes <= std::max(freely_given_bytes, largest_packing * file_bytes) && packing_is_possible(spec, file_bytes)))
        refuse_file(
            path, "size",
            fmt::format("{} x {} pixels, {:.0f} bytes, in a file of {:.0f} bytes", spec.width, spec.height, bytes,
                        file_bytes),
            fmt::format("at most {:.0f} pixels, and no more bytes than {:.0f} or {:.0f} times those of the file",
                        largest_pixel_count, freely_given_bytes, largest_packing),
            "The file is truncated or damaged: write or copy it anew; write a large image with less packing.");
}

template <class Value, class Stored>
Grid<Value> read_values(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, const std::filesystem::path& path,
                        int page, int channel) {
    [[maybe_unused]] const bool from_white = counts_from_white(input, spec);
    std::vector<Stored> stored(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height));
    // A strip that cannot be read leaves an error and zeros, but counts as success.
    if (!input.read_image(page, 0, channel, channel + 1, type_of<Stored>(), stored.data()) || input.has_error())
        refuse_file(path, fmt::format("page {}", page), input.geterror(), "pixel values up to the end of the image",
                    "The file is truncated or damaged: write or copy it anew.");
    if constexpr (std::is_unsigned_v<Stored>) {
        for (Stored& value : stored) {
            value = from_white ? static_cast<Stored>(std::numeric_limits<Stored>::max() - value) : value;
        }
    }
    return upright<Value>(stored, spec.width, spec.height, orientation_of(spec));
}

template <class Value>
Grid<Value> read_channel(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, const std::filesystem::path& path,
                         int page, int channel) {
    switch (spec.format.basetype) {
    case OIIO::TypeDesc::UINT8:
        return read_values<Value, std::uint8_t>(input, spec, path, page, channel);
    case OIIO::TypeDesc::INT8:
        return read_values<Value, std::int8_t>(input, spec, path, page, channel);
    case OIIO::TypeDesc::UINT16:
        return read_values<Value, std::uint16_t>(input, spec, path, page, channel);
    case OIIO::TypeDesc::INT16:
        return read_values<Value, std::int16_t>(input, spec, path, page, channel);
    case OIIO::TypeDesc::UINT32:
        return read_values<Value, std::uint32_t>(input, spec, path, page, channel);
    case OIIO::TypeDesc::INT32:
        return read_values<Value, std::int32_t>(input, spec, path, page, channel);
    case OIIO::TypeDesc::DOUBLE:
        return read_values<Value, Value>(input, spec, path, page, channel);
    default:
        return read_values<Value, float>(input, spec, path, page, channel);
    }
}

OIIO::ImageSpec spec_of_page(OIIO::ImageInput& input, const std::filesystem::path& path, int page) {
    if (!input.seek_subimage(page, 0))
        refuse_file(path, fmt::format("page {}", page), "no such page", "an image with that page",
                    "Count the pages of the file; the first is page 0.");
    return input.spec();
}

OIIO::ImageSpec flat_page(const OpenImage& image, const std::filesystem::path& path, int page) {
    OIIO::ImageSpec spec = spec_of_page(*image.input, path, page);
    if (spec.depth > 1)
        refuse_file(path, fmt::format("page {}", page), fmt::format("depth {}", spec.depth), "two dimensions",
                    "Write every plane as a page or file of its own.");
    check_size(image, spec, path);
    refuse_lost_values(*image.input, spec, path);
    return spec;
}

// Reads all channels except opacity.
template <class Value>
std::vector<Grid<Value>> read_all_channels(const OpenImage& image, const std::filesystem::path& path, int page) {
    const OIIO::ImageSpec spec = flat_page(image, path, page);
    std::vector<Grid<Value>> channels;
    for (int channel = 0; channel < spec.nchannels; ++channel)
        if (channel != opacity_channel(spec))
            channels.push_back(read_channel<Value>(*image.input, spec, path, page, channel));
    return channels;
}

template <class Value>
bool same_values(const Grid<Value>& one, const Grid<Value>& other) {
    return std::ranges::equal(one.values, other.values,
                              [](Value a, Value b) { return a == b || (std::isnan(a) && std::isnan(b)); });
}

// Reads a grey image, which some formats and palettes store as three equal channels.
template <class Value>
Grid<Value> read_page(const OpenImage& image, const std::filesystem::path& path, int page) {
    std::vector<Grid<Value>> channels = read_all_channels<Value>(image, path, page);
    const bool one = channels.size() == 1;
    if (!one &&
        !(channels.size() == 3 && same_values(channels[0], channels[1]) && same_values(channels[0], channels[2])))
        refuse_file(path, fmt::format("page {}", page), fmt::format("{} channels that differ", channels.size()),
                    "one grey channel", "Convert the image to greyscale.");
    return std::move(channels.front());
}

std::string description_of(const OpenImage& image) {
    return image.input->spec().get_string_attribute("ImageDescription");
}

} // namespace

int page_count(const std::filesystem::path& path) {
    const OpenImage image = open_image(path);
    int count = 1;
    while (image.input->seek_subimage(count, 0))
        ++count;
    return count;
}

Grid<float> read_image(const std::filesystem::path& path, int page) {
    return read_page<float>(open_image(path), path, page);
}

std::vector<Grid<float>> read_channels(const std::filesystem::path& path, int page) {
    return read_all_channels<float>(open_image(path), path, page);
}

ImageStatement image_statement(const std::filesystem::path& path) {
    const OpenImage image = open_image(path);
    const auto& spec = image.input->spec();
    const bool turned = orientation_of(spec) > 4;
    ImageStatement statement;
    statement.columns = turned ? spec.height : spec.width;
    statement.rows = turned ? spec.width : spec.height;
    statement.channels = spec.nchannels - (opacity_channel(spec) >= 0 ? 1 : 0);
    statement.description = description_of(image);
    // Cameras write both dates, and an edited image has different ones: that of the photograph, and that of the file.
    statement.date = spec.get_string_attribute("Exif:DateTimeOriginal", spec.get_string_attribute("DateTime"));
    // In other formats the resolution is that of a screen or of print.
    if (std::string_view(image.input->format_name()) == "tiff") {
        const std::string unit = spec.get_string_attribute("ResolutionUnit");
        statement.columns_per_unit = spec.get_float_attribute("XResolution");
        statement.rows_per_unit = spec.get_float_attribute("YResolution");
        statement.unit = unit == "in"   ? ImageStatement::Unit::inch
                         : unit == "cm" ? ImageStatement::Unit::centimetre
                                        : ImageStatement::Unit::none;
    }
    return statement;
}

StoredImage parse_tiff(std::string_view bytes, const std::filesystem::path& path) {
    const OpenImage image = open_image(bytes, path);
    std::string description = description_of(image);
    return {.values = read_page<float>(image, path, 0), .description = std::move(description)};
}

DescribedImage parse_image(std::string_view bytes, const std::filesystem::path& path) {
    const OpenImage image = open_image(bytes, path);
    DescribedImage result{.values = {}, .description = description_of(image)};
    if (result.description.starts_with("ImageJ=")) {
        result.columns_per_unit = image.input->spec().get_float_attribute("XResolution");
        result.rows_per_unit = image.input->spec().get_float_attribute("YResolution");
    }
    result.values = read_page<double>(image, path, 0);
    return result;
}

} // namespace vkfv::images::openimageio
