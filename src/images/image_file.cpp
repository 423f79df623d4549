// Files that vkfv wrote are read by libtiff; all others, and errors in them, are left to OpenImageIO.
#include "images/image_file.hpp"

#include "images/codec.hpp"
#include "images/tiff.hpp"

#include <algorithm>
#include <cmath>

namespace vkfv::images {
namespace {

// The plain TIFF at a path with a TIFF's ending; none otherwise, as OpenImageIO decides by the name's ending.
std::optional<PlainTiff> plain_file(const std::filesystem::path& path, TiffPart part) {
    const auto ending = path.extension();
    return ending == ".tif" || ending == ".tiff" ? plain_tiff_file(path, part) : std::nullopt;
}

} // namespace

std::string tiff_bytes(const Grid<float>& image, const ImageTags& tags) {
    return tiff_of_floats(std::span(&image, 1), tags);
}

std::string tiff_bytes(const std::vector<Grid<float>>& channels, const ImageTags& tags) {
    return tiff_of_floats(channels, tags);
}

std::string tiff_bytes(const Grid<std::uint16_t>& image, const ImageTags& tags) {
    return tiff_of_integers(image, tags);
}

std::string tiff_bytes(const Grid<std::uint8_t>& image, const ImageTags& tags) {
    return tiff_of_integers(image, tags);
}

int page_count(const std::filesystem::path& path) {
    return plain_file(path, TiffPart::header) ? 1 : codec().page_count(path);
}

Grid<float> read_image(const std::filesystem::path& path, int page) {
    if (page == 0) {
        if (const auto image = plain_file(path, TiffPart::all); image && image->channels == 1) {
            return image->channel<float>(0);
        }
    }
    return codec().read_image(path, page);
}

std::vector<Grid<float>> read_channels(const std::filesystem::path& path, int page) {
    const auto image = page == 0 ? plain_file(path, TiffPart::all) : std::nullopt;
    if (!image) {
        return codec().read_channels(path, page);
    }
    std::vector<Grid<float>> channels;
    for (int channel = 0; channel < image->channels; ++channel) {
        if (!image->opacity(channel)) {
            channels.push_back(image->channel<float>(channel));
        }
    }
    return channels;
}

ImageStatement image_statement(const std::filesystem::path& path) {
    return codec().image_statement(path); // plain TIFFs too, as it is called once for a stack
}

StoredImage parse_tiff(std::string_view bytes, const std::filesystem::path& path) {
    auto image = plain_tiff(bytes, TiffPart::all);
    if (!image || image->channels != 1) {
        return codec().parse_tiff(bytes, path);
    }
    return {.values = image->channel<float>(0), .description = std::move(image->description)};
}

DescribedImage parse_image(std::string_view bytes, const std::filesystem::path& path) {
    auto image = plain_tiff(bytes, TiffPart::all);
    if (!image || image->channels != 1 || image->description.starts_with("ImageJ=")) {
        return codec().parse_image(bytes, path);
    }
    return {.values = image->channel<double>(0), .description = std::move(image->description)};
}

Grid<float> parse_grey(std::string_view bytes, std::uint64_t most_pixels, const std::filesystem::path& path) {
    // Only floats are taken here, as OpenImageIO scales integers to 0..1.
    const auto image = plain_tiff(bytes, TiffPart::all);
    const auto finite = [](float value) { return std::isfinite(value); };
    if (image && image->channels == 1 && !image->integers && image->columns >= 2 && image->rows >= 2 &&
        image->floats.size() <= most_pixels && std::ranges::all_of(image->floats, finite)) {
        return image->channel<float>(0);
    }
    return codec().parse_grey(bytes, most_pixels, path);
}

} // namespace vkfv::images
