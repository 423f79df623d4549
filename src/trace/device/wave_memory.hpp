// How much of a device's memory light sorted by pupil cells takes, and how finely a device can sort it.
#pragma once

#include "optics/waves/pupil_filter.hpp"
#include "vulkan/device.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
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

// Bytes of the largest buffer that a device allocates, and of the largest that it lets kernels have by a binding.
std::uint64_t largest_buffer(const vulkan::DeviceReport& device);
std::uint64_t largest_binding(const vulkan::DeviceReport& device);
// How many cells' images of so many bytes lie in one buffer of at most so many, at least one.
std::size_t cells_in_a_buffer(std::uint64_t most_bytes, std::size_t bytes_a_cell);

// The numbers that the memory follows from.
struct WaveSizes {
    int cells = 0; // across the pupil
    int parts = 0; // of a pixel's side
    int tiles = 1; // across the field
    ImageSize pixels;
};

// On a GPU. binding: largest_binding().
WaveMemory wave_memory(const WaveSizes& sizes, std::uint64_t binding = std::numeric_limits<std::uint64_t>::max());
// Where the host's own cores are the device, and the host makes the transforms: of so many groups of four cells at a
// time, as many as it has cores.
WaveMemory wave_memory_of_host(const WaveSizes& sizes, int groups_at_once);

// The options with the pupil cells and the parts of a pixel that light is sorted in: those asked for, or as many as
// waves ask for, or where these are too many parts for the device, as many as it can hold. Throws InputError, which
// names the limit of the device, where it holds not even one, or not what was asked for.
optics::WaveOptions waves_on_device(const optics::WaveOptions& options, const optics::Instrument& instrument,
                                    const vulkan::DeviceReport& device);

} // namespace vkfv::trace
