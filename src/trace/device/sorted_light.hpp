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
// buffers as needed, each of whole images and in the order of the cells. Kernels reach them by a table of addresses
// (device/cell_light.glsl), so that no size of a binding bounds them.
class SortedLight {
  public:
    // cells: the number of images; numbers: in each image. most_bytes: of one buffer; 0: the largest that the device
    // allocates. The device must outlive it. Throws RunError where its memory does not hold the light.
    SortedLight(const vulkan::Device& device, std::size_t cells, std::size_t numbers, std::uint64_t most_bytes = 0);

    // The address of a table that holds for each cell the 64-bit address of its image's first number.
    vk::DeviceAddress address() const { return table_.address(); }
    // The buffers in the order of the cells; together they hold all numbers, one after another.
    std::vector<const vulkan::Buffer*> buffers() const;

    void clear(vulkan::Commands& commands) const;
    // Reads numbers of one cell's image, from `first` on, as they are now.
    void read(std::size_t cell, std::size_t first, std::span<std::uint64_t> numbers) const;
    // Writes all numbers, cell after cell.
    void write(std::span<const std::uint64_t> numbers);

  private:
    std::size_t bytes_a_cell_;
    std::size_t cells_a_buffer_;
    std::vector<vulkan::Buffer> buffers_;
    vulkan::Buffer table_;
};

} // namespace vkfv::trace
