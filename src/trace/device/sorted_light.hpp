// Light sorted by pupil cells, in a device's memory.
#pragma once

#include "vulkan/buffer.hpp"
#include "vulkan/device.hpp"
#include "vulkan/kernel.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vkfv::trace {

// An image of 64-bit integers for each cell. A device bounds the size of one allocation, so the images lie in as many
// buffers as that takes, each of whole images and in the order of the cells. Kernels reach them by a table of
// addresses (device/cell_light.glsl), so that no size of a binding bounds them.
class SortedLight {
  public:
    // cells: the number of images; numbers: of each. most_bytes: of one buffer; 0: what the device allocates at once.
    // The device must outlive it. Throws RunError where its memory does not hold the light.
    SortedLight(const vulkan::Device& device, std::size_t cells, std::size_t numbers, std::uint64_t most_bytes = 0);

    // The address of a table, which has for each cell the 64-bit address of the first number of its image.
    vk::DeviceAddress address() const { return table_.address(); }
    // In the order of the cells; all numbers of the light, one after another.
    std::vector<const vulkan::Buffer*> buffers() const;

    void clear(vulkan::Commands& commands) const;
    // The host reads numbers of one cell's image from `first` on, as they are now.
    void read(std::size_t cell, std::size_t first, std::span<std::uint64_t> numbers) const;
    // All numbers, cell after cell.
    void write(std::span<const std::uint64_t> numbers);

  private:
    std::size_t bytes_a_cell_;
    std::size_t cells_a_buffer_;
    std::vector<vulkan::Buffer> buffers_;
    vulkan::Buffer table_;
};

} // namespace vkfv::trace
