// The numbers that an exposure has counted in a device's memory, copied to a checkpoint and back.
#pragma once

#include "trace/device/exposure_work.hpp"
#include "vulkan/buffer.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vkfv::trace {

class DeviceNumbers {
  public:
    // buffers: of 64-bit integers. They and the device must outlive it.
    DeviceNumbers(const vulkan::Device& device, std::vector<const vulkan::Buffer*> buffers);

    std::size_t count() const { return bytes_ / sizeof(std::uint64_t); }
    // Reads all numbers after the submitted work has been done; waits for it.
    std::vector<std::uint64_t> read(ExposureWork& work) const;
    void write(ExposureWork& work, std::span<const std::uint64_t> numbers) const;

  private:
    struct Piece { // a part of a buffer
        const vulkan::Buffer* buffer;
        std::size_t first_byte;
        std::size_t bytes;
    };
    // All buffers one after the other, divided into loads of at most so many bytes, a multiple of 8.
    std::vector<std::vector<Piece>> loads(std::size_t most_bytes) const;
    vulkan::Buffer& staging() const;

    const vulkan::Device* device_;
    std::vector<const vulkan::Buffer*> buffers_;
    std::size_t bytes_ = 0;
    mutable std::optional<vulkan::Buffer> staging_; // few exposures are long enough to need it
};

} // namespace vkfv::trace
