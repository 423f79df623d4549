#include "trace/device/wave_memory.hpp"

#include "core/messages/error.hpp"
#include "trace/device/wave_planes.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace vkfv::trace {

namespace {

constexpr double usable_share = 0.8; // of a device's memory: the specimen, the kernels and other programs have the rest
constexpr std::uint64_t padding = 128; // of a buffer (vulkan/buffer.hpp)

struct Limits {
    std::uint64_t memory = 0;
    std::uint64_t buffer = 0;  // of one, reached by its address
    std::uint64_t binding = 0; // of one that kernels are given
};

Limits limits_of(const optics::WaveOptions& options, const vulkan::DeviceReport& device) {
    const auto usable = static_cast<std::uint64_t>(usable_share * static_cast<double>(device.memory_bytes));
    const std::uint64_t all = options.most_memory > 0 ? std::min(options.most_memory, usable) : usable;
    return {.memory = all / static_cast<std::uint64_t>(options.sharers),
            .buffer = device.max_allocation_bytes - padding,
            .binding = std::min(device.max_storage_buffer_bytes, device.max_allocation_bytes - padding)};
}

WavePlanes planes_of(int cells, int parts, ImageSize pixels) {
    return {cells, {pixels.columns * parts, pixels.rows * parts}};
}

bool fits(int cells, int parts, ImageSize pixels, const Limits& limits) {
    const WaveMemory memory = wave_memory(cells, parts, pixels);
    return memory.all() <= limits.memory && memory.light <= limits.buffer &&
           planes_of(cells, parts, pixels).largest_bytes() <= limits.binding;
}

} // namespace

WaveMemory wave_memory(int cells, int parts, ImageSize pixels) {
    const auto in_a_pixel = static_cast<std::uint64_t>(parts) * static_cast<std::uint64_t>(parts);
    const auto count = static_cast<std::uint64_t>(cells) * static_cast<std::uint64_t>(cells);
    const WavePlanes planes = planes_of(cells, parts, pixels);
    return {.light = count * in_a_pixel * pixels.count() * sizeof(std::uint64_t),
            .transforms = 2 * (planes.plane_bytes() + planes.image_bytes()) + planes.spectrum_bytes()};
}

optics::WaveOptions waves_on_device(const optics::WaveOptions& options, const optics::Instrument& instrument,
                                    const vulkan::DeviceReport& device) {
    const ImageSize pixels = instrument.detector_pixels();
    const Limits limits = limits_of(options, device);
    optics::WaveOptions fitted = options;
    fitted.cells = optics::cells_of(options, instrument);
    fitted.parts = optics::parts_of(options, instrument);
    const int least = options.parts > 0 ? options.parts : 1;
    while (fitted.parts >= least && !fits(fitted.cells, fitted.parts, pixels, limits)) {
        --fitted.parts;
    }
    if (fitted.parts < least) {
        throw InputError({.where = {},
                          .key = options.parts > 0 ? "diffraction.parts_per_pixel" : "diffraction.cells",
                          .found = fmt::format("{} x {} cells, {} x {} parts of {} x {} pixels: {} bytes of light",
                                               fitted.cells, fitted.cells, least, least, pixels.columns, pixels.rows,
                                               wave_memory(fitted.cells, least, pixels).all()),
                          .expected = fmt::format("at most {} bytes on {}, {} in one buffer", limits.memory,
                                                  device.name, limits.buffer),
                          .remedy = "Take fewer detector.pixels, fewer diffraction.cells or diffraction."
                                    "parts_per_pixel, another device, or diffraction.model = \"none\"."});
    }
    return fitted;
}

} // namespace vkfv::trace
