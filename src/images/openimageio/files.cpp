// Image files of all kinds: what images/image_file.hpp promises.
#include "images/openimageio/functions.hpp"
#include "images/openimageio/packing.hpp"

#include "core/error.hpp"
#include "core/file.hpp"
#include "images/exr_header.hpp"
#include "images/pnm_header.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string_view>
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

template <class Value>
std::vector<Value> flipped_rows(const Grid<Value>& grid) {
    std::vector<Value> result(grid.values.size());
    for (int row = 0; row < grid.rows; ++row) {
        const auto source = grid.values.begin() + static_cast<std::ptrdiff_t>(grid.index(0, row));
        std::copy_n(source, grid.columns,
                    result.begin() + static_cast<std::ptrdiff_t>(grid.index(0, grid.rows - 1 - row)));
    }
    return result;
}

struct OpenImage {
    // What the input reads, which must outlive it: an open file or its bytes.
    std::unique_ptr<InputFile> file;
    std::unique_ptr<std::string> owned;
    std::unique_ptr<OIIO::Filesystem::IOProxy> source;
    std::unique_ptr<OIIO::ImageInput> input;
    double bytes; // of the whole file
};

OpenImage open_image(std::string_view bytes, ImageFormat format, const std::filesystem::path& path) {
    if (format == ImageFormat::openexr)
        check_exr_attributes(bytes, path);
    // By format name: tried one after the other, every reader that OpenImageIO has would be offered the bytes.
    OpenImage image{.file = nullptr,
                    .owned = nullptr,
                    .source = std::make_unique<OIIO::Filesystem::IOMemReader>(bytes.data(), bytes.size()),
                    .input = OIIO::ImageInput::create(format == ImageFormat::tiff ? "tiff" : "openexr"),
                    .bytes = static_cast<double>(bytes.size())};
    if (!image.input)
        throw RunError(fmt::format("OpenImageIO cannot read the kind of {}: {}", path.string(), OIIO::geterror()));
    OIIO::ImageSpec spec;
    if (!image.input->set_ioproxy(image.source.get()) || !image.input->open(path.string(), spec))
        refuse_file(path, "", image.input->geterror(), "a readable image",
                    "Write the file anew, as single-channel TIFF.");
    return image;
}

OpenImage open_image(const std::filesystem::path& path) {
    auto file = std::make_unique<InputFile>(path, FileRequest{.expected = "an image file"});
    constexpr std::uint64_t magic_bytes = 4;
    const std::string magic = file->read(magic_bytes);
    if (looks_like_pnm(magic))
        check_pnm(file->read(), path);
    if (looks_like_exr(magic)) {
        auto owned = std::make_unique<std::string>(file->read());
        OpenImage image = open_image(*owned, ImageFormat::openexr, path);
        image.owned = std::move(owned);
        return image;
    }
    OIIO::ImageSpec as_stored;
    as_stored.attribute("oiio:UnassociatedAlpha", 1); // colours are not multiplied by their opacity
    auto source = std::make_unique<OIIO::Filesystem::IOFile>(file->stream(), OIIO::Filesystem::IOProxy::Read);
    // Named in the configuration too: where there is one, OpenImageIO 2.4 looks for it nowhere else.
    OIIO::Filesystem::IOProxy* proxy = source.get();
    as_stored.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    // The ending hints at the format; of the rest of a name OpenImageIO takes what follows a '?' for options.
    auto input = OIIO::ImageInput::open("image" + path.extension().string(), &as_stored, source.get());
    if (!input)
        refuse_file(path, "", OIIO::geterror(), "a readable image", "Write the file anew, as single-channel TIFF.");
    const auto bytes = static_cast<double>(file->bytes());
    return {.file = std::move(file),
            .owned = nullptr,
            .source = std::move(source),
            .input = std::move(input),
            .bytes = bytes};
}

// What a header may ask for before a pixel is read: small images as they come, larger ones as far as the file's own
// size speaks for them.
constexpr double largest_pixel_count = 1 << 28;
constexpr double freely_given_bytes = 1 << 28;
constexpr double largest_packing = 64;

void check_size(const OpenImage& image, const OIIO::ImageSpec& spec, const std::filesystem::path& path) {
    const double pixels = static_cast<double>(spec.width) * spec.height;
    const double bytes = pixels * spec.nchannels * static_cast<double>(spec.format.size());
    if (!(spec.width > 0 && spec.height > 0 && pixels <= largest_pixel_count &&
          bytes <= std::max(freely_given_bytes, largest_packing * image.bytes) &&
          packing_is_possible(spec, image.bytes)))
        refuse_file(
            path, "size",
            fmt::format("{} x {} pixels, {:.0f} bytes, in a file of {:.0f} bytes", spec.width, spec.height, bytes,
                        image.bytes),
            fmt::format("at most {:.0f} pixels, and no more bytes than {:.0f} or {:.0f} times those of the file",
                        largest_pixel_count, freely_given_bytes, largest_packing),
            "The file is truncated or damaged: write or copy it anew; write a large image with less packing.");
}

template <class Value, class Stored>
Grid<Value> read_values(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, const std::filesystem::path& path,
                        int page, int channel) {
    Grid<Stored> stored(spec.width, spec.height);
    // A strip that cannot be read leaves an error and zeros, but counts as success.
    if (!input.read_image(page, 0, channel, channel + 1, type_of<Stored>(), stored.values.data()) || input.has_error())
        refuse_file(path, fmt::format("page {}", page), input.geterror(), "pixel values up to the end of the image",
                    "The file is truncated or damaged: write or copy it anew.");
    const std::vector<Stored> rows = flipped_rows(stored);
    Grid<Value> image(spec.width, spec.height);
    std::transform(rows.begin(), rows.end(), image.values.begin(),
                   [](Stored value) { return static_cast<Value>(value); });
    return image;
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

template <class Value>
Grid<Value> read_page(const OpenImage& image, const std::filesystem::path& path, int page) {
    const OIIO::ImageSpec spec = spec_of_page(*image.input, path, page);
    if (spec.nchannels != 1 || spec.depth > 1)
        refuse_file(path, fmt::format("page {}", page),
                    fmt::format("{} channels, depth {}", spec.nchannels, spec.depth), "one channel and two dimensions",
                    "Convert the image to greyscale without alpha.");
    check_size(image, spec, path);
    return read_channel<Value>(*image.input, spec, path, page, 0);
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
    const OpenImage image = open_image(path);
    const OIIO::ImageSpec spec = spec_of_page(*image.input, path, page);
    if (spec.depth > 1)
        refuse_file(path, fmt::format("page {}", page), fmt::format("depth {}", spec.depth), "two dimensions",
                    "Write every plane as a page or file of its own.");
    check_size(image, spec, path);
    std::vector<Grid<float>> channels;
    for (int channel = 0; channel < spec.nchannels; ++channel)
        if (channel != spec.alpha_channel)
            channels.push_back(read_channel<float>(*image.input, spec, path, page, channel));
    return channels;
}

std::string image_description(const std::filesystem::path& path) {
    return description_of(open_image(path));
}

StoredImage parse_tiff(std::string_view bytes, const std::filesystem::path& path) {
    const OpenImage image = open_image(bytes, ImageFormat::tiff, path);
    std::string description = description_of(image);
    return {.values = read_page<float>(image, path, 0), .description = std::move(description)};
}

DescribedImage parse_image(std::string_view bytes, ImageFormat format, const std::filesystem::path& path) {
    const OpenImage image = open_image(bytes, format, path);
    std::string description = description_of(image);
    return {.values = read_page<double>(image, path, 0), .description = std::move(description)};
}

} // namespace vkfv::images::openimageio
