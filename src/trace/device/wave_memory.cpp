#include "trace/device/wave_memory.hpp"

#include "core/messages/error.hpp"
#include "trace/device/wave_planes.hpp"
#include "trace/interface/wave_windows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

namespace vkfv::trace {

namespace {

constexpr double usable_share = 0.8;   // share of memory; the rest is for specimen, kernels and other programs
constexpr std::uint64_t padding = 128; // bytes that a buffer is padded by (vulkan/buffer.hpp)

ImageSize in_parts(int parts, ImageSize pixels) {
    return {pixels.columns * parts, pixels.rows * parts};
}

std::uint64_t bytes_a_cell(const WaveSizes& sizes) {
    return in_parts(sizes.parts, sizes.pixels).count() * sizeof(std::uint64_t);
}

std::uint64_t light_bytes(const WaveSizes& sizes) {
    const auto side = static_cast<std::uint64_t>(sizes.cells);
    return side * side * bytes_a_cell(sizes);
}

// Bytes of the tables of all tiles, and of the table of the four filters of a window.
std::uint64_t table_bytes(const WaveSizes& sizes) {
    const auto steps = static_cast<std::uint64_t>(optics::table_steps(sizes.cells));
    const auto cells = static_cast<std::uint64_t>(sizes.cells);
    const auto tiles = static_cast<std::uint64_t>(sizes.tiles);
    return (tiles * tiles + 4) * cells * cells * (2 * steps + 1) * (steps + 1) * 2 * sizeof(float);
}

WavePlanes planes_of(const WaveSizes& sizes, std::uint64_t binding) {
    const WaveWindow window = wave_windows(sizes.tiles, sizes.pixels, sizes.parts).front();
    return {sizes.cells, in_parts(sizes.parts, window.size), window.filters, binding};
}

// A limit of a device that the light or its transforms exceed.
struct Violation {
    const char* key;
    std::string found;
    std::string expected;
};

// The limit of the device that forbids so many cells and parts; none if it holds them.
std::optional<Violation> violation(const optics::WaveOptions& options, ImageSize pixels,
                                   const vulkan::DeviceReport& device) {
    const WaveSizes sizes{.cells = options.cells, .parts = options.parts, .tiles = options.tiles, .pixels = pixels};
    const bool software = vulkan::is_software(device);
    const std::uint64_t binding = largest_binding(device);
    // One group at a time is the least that a host needs: the parts must not depend on its number of cores.
    const WaveMemory memory = software ? wave_memory_of_host(sizes, 1) : wave_memory(sizes, binding);
    const auto usable = static_cast<std::uint64_t>(usable_share * static_cast<double>(device.memory_bytes));
    const bool bounded = options.most_memory > 0 && options.most_memory < usable;
    const std::uint64_t allowed =
        (bounded ? options.most_memory : usable) / static_cast<std::uint64_t>(options.sharers);
    const std::string sorted = fmt::format("{} x {} cells, {} x {} parts of {} x {} pixels", sizes.cells, sizes.cells,
                                           sizes.parts, sizes.parts, pixels.columns, pixels.rows);
    if (memory.all() > allowed) {
        return Violation{
            .key = "diffraction.cells",
            .found =
                fmt::format("{}: {} bytes of light and {} to transform it", sorted, memory.light, memory.transforms),
            .expected = fmt::format("at most {} bytes in all, {}{}", allowed,
                                    bounded ? "by diffraction.most_memory_gib"
                                            : fmt::format("four fifths of the memory of {}", device.name),
                                    options.sharers > 1 ? fmt::format(" shared by {} sources", options.sharers) : "")};
    }
    if (const std::uint64_t image = bytes_a_cell(sizes); image > largest_buffer(device)) {
        return Violation{.key = "detector.pixels",
                         .found = fmt::format("{}: {} bytes of light for each cell", sorted, image),
                         .expected = fmt::format("at most {} bytes, the largest allocation of {}",
                                                 largest_buffer(device), device.name)};
    }
    const std::uint64_t transform = planes_of(sizes, binding).largest_bytes();
    if (!software && transform > binding) {
        return Violation{.key = "detector.pixels",
                         .found = fmt::format("{}: {} bytes for the transform of the image with its mirror images",
                                              sorted, transform),
                         .expected = fmt::format("at most {} bytes, the largest buffer that {} lets a kernel have",
                                                 binding, device.name)};
    }
    return std::nullopt;
}

} // namespace

std::uint64_t largest_buffer(const vulkan::DeviceReport& device) {
    return device.max_allocation_bytes - std::min(padding, device.max_allocation_bytes);
}

std::uint64_t largest_binding(const vulkan::DeviceReport& device) {
    return std::min(device.max_storage_buffer_bytes, largest_buffer(device));
}

std::size_t cells_in_a_buffer(std::uint64_t most_bytes, std::size_t bytes_a_cell) {
    return std::max<std::size_t>(1, most_bytes / std::max<std::size_t>(1, bytes_a_cell));
}

WaveMemory wave_memory(const WaveSizes& sizes, std::uint64_t binding) {
    const WavePlanes planes = planes_of(sizes, binding);
    const std::uint64_t tables = sizes.tiles > 1 ? table_bytes(sizes) : 0; // a single tile's table is small
    return {.light = light_bytes(sizes),
            .transforms = 2 * (planes.plane_bytes() + planes.image_bytes()) + planes.spectrum_bytes() + tables};
}

WaveMemory wave_memory_of_host(const WaveSizes& sizes, int groups_at_once) {
    const WaveWindow window = wave_windows(sizes.tiles, sizes.pixels, sizes.parts).front();
    const std::uint64_t count = in_parts(sizes.parts, window.size).count();
    const std::uint64_t read = count / static_cast<std::uint64_t>(window.size.columns) *
                               static_cast<std::uint64_t>(sizes.pixels.columns); // whole rows are read
    const auto at_once = static_cast<std::uint64_t>(std::min(groups_at_once, sizes.cells * sizes.cells / 4));
    constexpr std::uint64_t complex_bytes = 2 * sizeof(double), cells_a_group = 4;
    // Each part of a pixel takes two frequencies of the spectra; besides these there are first the images and
    // transforms of the cells at a time, and afterwards the image with its mirror images and the pixels.
    const std::uint64_t spectra = static_cast<std::uint64_t>(window.filters) * count * 2 * complex_bytes;
    const std::uint64_t groups = at_once * cells_a_group * (read * sizeof(std::uint64_t) + count * sizeof(double));
    const std::uint64_t image = count * (4 * complex_bytes + sizeof(double));
    return {.light = light_bytes(sizes), .transforms = spectra + std::max(groups, image)};
}

optics::WaveOptions waves_on_device(const optics::WaveOptions& options, const optics::Instrument& instrument,
                                    const vulkan::DeviceReport& device) {
    const ImageSize pixels = instrument.detector_pixels();
    optics::WaveOptions fitted = optics::resolved(options, instrument);
    const int least = options.parts > 0 ? options.parts : 1;
    while (auto forbidden = violation(fitted, pixels, device)) {
        if (fitted.parts == least) {
            throw InputError({.where = {},
                              .key = options.parts > 0 ? "diffraction.parts_per_pixel" : forbidden->key,
                              .found = std::move(forbidden->found),
                              .expected = std::move(forbidden->expected),
                              .remedy = "Take fewer detector.pixels, fewer diffraction.cells or diffraction."
                                        "parts_per_pixel, another device, or diffraction.model = \"none\"."});
        }
        --fitted.parts;
    }
    return fitted;
}

} // namespace vkfv::trace
