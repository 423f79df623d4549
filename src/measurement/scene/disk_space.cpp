#include "measurement/scene/disk_space.hpp"

#include "core/messages/error.hpp"
#include "scan/stack_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace vkfv::measurement {

namespace {

constexpr std::uint64_t bytes_around_pixels = 4096; // of an image file: its description and the rest of a disk block
constexpr std::uint64_t bytes_a_point = 54;         // nine maps in float32, the mask, and two surfaces
constexpr std::uint64_t report_bytes = 6'000'000;   // of the page without frames and curves
constexpr std::uint64_t most_frame_bytes = 8'000'000;
constexpr std::uint64_t curve_bytes = std::uint64_t{64} * 64 * 6; // for each image, in curves.npy and in the report
constexpr std::uint64_t most_curve_values = 2048;

// The bytes of the report's page, with its frames and curves, and of curves.npy.
std::uint64_t page_bytes(const Configuration& configuration) {
    const std::uint64_t images = configuration.scan ? configuration.scan->positions().size() : 0;
    return report_bytes +
           std::min(most_frame_bytes, images * configuration.instrument.detector_pixels.count() * 4 / 3) +
           std::min(most_curve_values, images) * curve_bytes;
}

} // namespace

std::uint64_t image_bytes(ImageSize pixels) {
    return pixels.count() * sizeof(float) + bytes_around_pixels;
}

std::uint64_t results_bytes(const Configuration& configuration) {
    const std::uint64_t once =
        configuration.instrument.detector_pixels.count() * bytes_a_point + page_bytes(configuration);
    const std::uint64_t evaluated = configuration.diffraction.any() && !configuration.camera ? 2 * once : once;
    return evaluated +
           (configuration.stack_file && configuration.scan
                ? scan::stack_file_bytes(configuration.scan->positions().size(),
                                         configuration.instrument.detector_pixels.count(), configuration.pixel_type)
                : 0);
}

std::uint64_t free_bytes(const std::filesystem::path& folder) {
    std::error_code error;
    auto there = std::filesystem::absolute(folder, error).lexically_normal();
    while (!std::filesystem::exists(there, error) && there.has_relative_path()) {
        there = there.parent_path();
    }
    const auto space = std::filesystem::space(there, error);
    // A file system that does not tell its free space is taken as large enough; writing will show.
    return error ? std::numeric_limits<std::uint64_t>::max() : space.available;
}

void require_space(const scan::ImageStore& store, std::uint64_t results) {
    std::uint64_t missing = 0;
    const auto images = static_cast<int>(store.description().positions.size());
    for (int image = 0; image < images; ++image) {
        missing += store.shard().holds(image) && !store.stored(image) ? 1 : 0;
    }
    const std::uint64_t images_bytes = missing * image_bytes({store.description().columns, store.description().rows});
    const std::uint64_t available = free_bytes(store.folder());
    if (images_bytes + results > available) {
        throw RunError(fmt::format("{}: {} images and the results take {}, but the disk has {} left. Free space, give "
                                   "another --out, or take fewer images or pixels",
                                   store.folder().string(), missing, bytes_text(images_bytes + results),
                                   bytes_text(available)));
    }
}

std::string bytes_text(std::uint64_t bytes) {
    constexpr std::array units = {"bytes", "kB", "MB", "GB", "TB", "PB"};
    auto value = static_cast<double>(bytes);
    std::size_t unit = 0;
    for (; value >= 1000 && unit + 1 < units.size(); ++unit) {
        value /= 1000;
    }
    return fmt::format("{:.3g} {}", value, units[unit]);
}

} // namespace vkfv::measurement
