#include "scan/image_series.hpp"

#include "core/messages/error.hpp"
#include "images/image_file.hpp"
#include "scan/image_order.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

namespace vkfv::scan {

namespace {

constexpr std::array extensions = {".tif", ".tiff", ".png", ".bmp", ".jpg", ".jpeg", ".jp2", ".j2k", ".webp",
                                   ".exr", ".hdr",  ".pgm", ".ppm", ".pnm", ".pfm",  ".pbm", ".tga"};

bool is_image(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
    return std::ranges::find(extensions, extension) != extensions.end() && file.filename().string().front() != '.';
}

} // namespace

ImageSeries::ImageSeries(const std::filesystem::path& path) {
    if (std::filesystem::is_directory(path)) {
        std::vector<std::filesystem::path> files;
        for (const auto& entry : std::filesystem::directory_iterator(path)) {
            if (entry.is_regular_file() && is_image(entry.path())) {
                files.push_back(entry.path());
            }
        }
        std::ranges::sort(files); // the folder has no order of its own
        std::vector<std::string> names;
        std::ranges::transform(files, std::back_inserter(names), [](const auto& file) { return file.stem().string(); });
        const auto [order, doubt] = order_of_names(names);
        for (const std::size_t place : order) {
            images_.push_back({files[place], 0});
        }
        if (!doubt.empty()) {
            spdlog::warn("{}: the heights of the images are in doubt: {}", path.string(), doubt);
        }
        if (images_.empty()) {
            refuse_file(
                path, "", "no stack.toml and no image",
                fmt::format("stack.toml or files {}", fmt::join(extensions, ", ")),
                "Give the folder of a stack of vkfv, one with the images of another, or a TIFF file of several pages. "
                "Develop a camera's raw files to TIFF, all with the same settings.");
        }
        return;
    }
    if (!std::filesystem::exists(path)) {
        refuse_file(path, "", "no such file or folder",
                    "the folder of a stack (with its stack.toml), a folder of images, or a TIFF file of several pages",
                    "Check the path.");
    }
    for (int page = 0, pages = images::page_count(path); page < pages; ++page) {
        images_.push_back({path, page});
    }
}

std::string ImageSeries::name(int image) const {
    const Place& place = images_.at(static_cast<std::size_t>(image));
    const std::string file = place.file.filename().string();
    return images_.front().file == images_.back().file ? fmt::format("{}, page {}", file, place.page) : file;
}

std::vector<Grid<float>> ImageSeries::read(int image) const {
    const Place& place = images_.at(static_cast<std::size_t>(image));
    return images::read_channels(place.file, place.page);
}

} // namespace vkfv::scan
