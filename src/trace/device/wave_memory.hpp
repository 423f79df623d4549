// The share of a device's memory that light sorted by pupil cells takes, and the finest sorting that a device can hold.
#pragma once

#include "optics/waves/pupil_filter.hpp"
#include "vulkan/device.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>

namespace vkfv::trace {

// Remedy that messages name where the memory runs out.
inline constexpr std::string_view wave_memory_remedy =
    "set fewer diffraction.cells or diffraction.parts_per_pixel, take fewer pixels or diffraction.model = \"none\"";

// Device memory in bytes.
struct WaveMemory {
    std::uint64_t light = 0;      // 64 bits a cell and part of a pixel
    std::uint64_t transforms = 0; // upper bound: VkFFT may take as much again as the data that it transforms
    std::uint64_t all() const { return light + transforms; }
};

// Bytes of the largest buffer that a device allocates, and of the largest that kernels can reach by a binding.
std::uint64_t largest_buffer(const vulkan::DeviceReport& device);
std::uint64_t largest_binding(const vulkan::DeviceReport& device);
// The number of cells' images of so many bytes that fit in one buffer of at most so many; at least one.
std::size_t cells_in_a_buffer(std::uint64_t most_bytes, std::size_t bytes_a_cell);

// The sizes that the memory follows from.
struct WaveSizes {
    int cells = 0; // pupil cells across the pupil
    int parts = 0; // parts that a pixel's side is divided into
    int tiles = 1; // tiles across the field
    ImageSize pixels;
};

// The memory needed on a GPU. binding: largest_binding().
WaveMemory wave_memory(const WaveSizes& sizes, std::uint64_t binding = std::numeric_limits<std::uint64_t>::max());
// The memory needed where the host's own cores are the device and the host makes the transforms. groups_at_once: groups
// of four cells that it transforms at a time, one a core.
WaveMemory wave_memory_of_host(const WaveSizes& sizes, int groups_at_once);

// The options with the numbers of pupil cells and of parts of a pixel set: those asked for, or as many parts as waves
// need, or where these are too many for the device, as many as it can hold. Throws InputError, which names the limit of
// the device, where it cannot hold even one, or cannot hold what was asked for.
optics::WaveOptions waves_on_device(const optics::WaveOptions& options, const optics::Instrument& instrument,
                                    const vulkan::DeviceReport& device);

} // namespace vkfv::trace
