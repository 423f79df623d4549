// How much of a device's memory light sorted by pupil cells takes, and how finely a device can sort it.
#pragma once

#include "optics/waves/pupil_filter.hpp"
#include "vulkan/device.hpp"

#include <cstdint>
#include <string_view>

namespace vkfv::trace {

// What helps where it runs out.
inline constexpr std::string_view wave_memory_remedy =
    "set fewer diffraction.cells or diffraction.parts_per_pixel, take fewer pixels or diffraction.model = \"none\"";

// Bytes.
struct WaveMemory {
    std::uint64_t light = 0;      // 64 bits a cell and part of a pixel
    std::uint64_t transforms = 0; // at most: VkFFT may take as much again as what it transforms
    std::uint64_t all() const { return light + transforms; }
};

// On a GPU. cells: across the pupil; parts: of a pixel's side; pixels: of the detector.
WaveMemory wave_memory(int cells, int parts, ImageSize pixels);

// The options with the pupil cells and the parts of a pixel that light is sorted in: those asked for, or as many as
// waves ask for, or where these are too many parts for the device, as many as it can hold. Throws InputError where it
// holds not even one, or not what was asked for.
optics::WaveOptions waves_on_device(const optics::WaveOptions& options, const optics::Instrument& instrument,
                                    const vulkan::DeviceReport& device);

} // namespace vkfv::trace
