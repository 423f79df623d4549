#include "trace/device/sorted_light.hpp"

#include "trace/device/wave_memory.hpp"

#include <algorithm>

namespace vkfv::trace {

namespace {

std::vector<vulkan::Buffer> buffers_of(const vulkan::Device& device, std::size_t cells, std::size_t cells_a_buffer,
                                       std::size_t bytes_a_cell) {
    std::vector<vulkan::Buffer> buffers;
    for (std::size_t first = 0; first < cells; first += cells_a_buffer) {
        buffers.emplace_back(device, std::min(cells_a_buffer, cells - first) * bytes_a_cell,
                             vulkan::Buffer::Memory::device, wave_memory_remedy);
    }
    return buffers;
}

} // namespace

SortedLight::SortedLight(const vulkan::Device& device, std::size_t cells, std::size_t numbers, std::uint64_t most_bytes)
    : bytes_a_cell_(numbers * sizeof(std::uint64_t)),
      cells_a_buffer_(cells_in_a_buffer(most_bytes > 0 ? most_bytes : largest_buffer(device.report()), bytes_a_cell_)),
      buffers_(buffers_of(device, cells, cells_a_buffer_, bytes_a_cell_)),
      table_(device, cells * sizeof(vk::DeviceAddress)) {
    std::vector<vk::DeviceAddress> addresses;
    for (std::size_t cell = 0; cell < cells; ++cell) {
        addresses.push_back(buffers_[cell / cells_a_buffer_].address() + cell % cells_a_buffer_ * bytes_a_cell_);
    }
    table_.write_values(std::span<const vk::DeviceAddress>(addresses));
}

std::vector<const vulkan::Buffer*> SortedLight::buffers() const {
    std::vector<const vulkan::Buffer*> all;
    for (const vulkan::Buffer& buffer : buffers_) {
        all.push_back(&buffer);
    }
    return all;
}

void SortedLight::clear(vulkan::Commands& commands) const {
    for (const vulkan::Buffer& buffer : buffers_) {
        commands.fill_zero(buffer);
    }
    commands.barrier();
}

void SortedLight::read(std::size_t cell, std::size_t first, std::span<std::uint64_t> numbers) const {
    buffers_[cell / cells_a_buffer_].read(std::as_writable_bytes(numbers),
                                          cell % cells_a_buffer_ * bytes_a_cell_ + first * sizeof(std::uint64_t));
}

void SortedLight::write(std::span<const std::uint64_t> numbers) {
    std::size_t first = 0;
    for (vulkan::Buffer& buffer : buffers_) {
        const std::size_t count = buffer.bytes() / sizeof(std::uint64_t);
        buffer.write_values(numbers.subspan(first, count));
        first += count;
    }
}

} // namespace vkfv::trace
