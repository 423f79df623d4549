// Buffers in the memory of a device.
#pragma once

#include "vulkan/device.hpp"
#include "vulkan/failure.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace vkfv::vulkan {

struct GiveBackMemory {
    std::int64_t bytes = 0;
    void operator()(const Device* device) const { device->count_memory(-bytes); }
};

// A buffer for storage, uniforms, transfers, device addresses and build input. Sizes in bytes; move-only.
class Buffer {
  public:
    enum class Memory {
        device, // fast; written and read through a staging copy
        host,   // mapped and coherent; for data that the host reads back or writes often
    };
    // Contents are undefined. The allocation is at least 64 bytes larger and a multiple of 64: GPU-assisted validation
    // misreads the last scalar-packed record. remedy: advice for the error on what takes less memory. Throws RunError
    // with sizes when the device cannot give `bytes`.
    Buffer(const Device& device, std::size_t bytes, Memory memory = Memory::device,
           std::string_view remedy = usual_memory_remedy);

    std::size_t bytes() const { return bytes_; }
    vk::Buffer handle() const { return *buffer_; }
    vk::DeviceAddress address() const;

    // Synchronous copies, any memory. Offsets and sizes in bytes, checked.
    void write(std::span<const std::byte> data, std::size_t offset = 0);
    void read(std::span<std::byte> data, std::size_t offset = 0) const;
    void fill_zero();

    template <class Value>
    void write_values(std::span<const Value> values, std::size_t first = 0) {
        write(std::as_bytes(values), first * sizeof(Value));
    }
    template <class Value>
    std::vector<Value> read_values(std::size_t count, std::size_t first = 0) const {
        std::vector<Value> values(count);
        read(std::as_writable_bytes(std::span(values)), first * sizeof(Value));
        return values;
    }

    // The present contents of host memory, without a copy.
    template <class Value>
    std::span<const Value> values(std::size_t count, std::size_t first_byte = 0) const {
        const std::span<const std::byte> bytes = mapped().subspan(first_byte, count * sizeof(Value));
        return {reinterpret_cast<const Value*>(bytes.data()), count};
    }

  private:
    std::span<const std::byte> mapped() const;

    const Device* device_;
    std::size_t bytes_ = 0;
    Memory memory_;
    vk::raii::Buffer buffer_{nullptr};
    vk::raii::DeviceMemory allocation_{nullptr};
    std::unique_ptr<const Device, GiveBackMemory> counted_;
    std::byte* mapped_ = nullptr;
};

} // namespace vkfv::vulkan
