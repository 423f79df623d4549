#include "vulkan/buffer.hpp"

#include "core/messages/error.hpp"
#include "vulkan/failure.hpp"
#include "vulkan/kernel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace vkfv::vulkan {

namespace {

constexpr std::size_t padding = 64;
constexpr std::size_t staging_bytes = std::size_t{64} << 20;

vk::BufferUsageFlags usage_on(const Device& device) {
    using Usage = vk::BufferUsageFlagBits;
    vk::BufferUsageFlags usage = Usage::eStorageBuffer | Usage::eUniformBuffer | Usage::eTransferSrc |
                                 Usage::eTransferDst | Usage::eShaderDeviceAddress;
    if (device.builds_structures()) {
        usage |= Usage::eAccelerationStructureBuildInputReadOnlyKHR | Usage::eAccelerationStructureStorageKHR;
    }
    if (device.has_ray_pipelines()) {
        usage |= Usage::eShaderBindingTableKHR;
    }
    return usage;
}

[[noreturn]] void throw_too_large(const Device& device, std::size_t bytes, std::string_view limit,
                                  std::uint64_t allowed, std::string_view remedy) {
    throw RunError(fmt::format("A buffer of {} bytes does not fit on {}: its {} is {} bytes. Choose another device, {}",
                               bytes, device.report().name, limit, allowed, remedy));
}

// Memory type for the host: cached memory if there is any, since the host reads other memory slowly.
std::uint32_t host_memory_type(const Device& device, std::uint32_t type_bits) {
    using Property = vk::MemoryPropertyFlagBits;
    const vk::MemoryPropertyFlags needed = Property::eHostVisible | Property::eHostCoherent;
    try {
        return device.memory_type(type_bits, needed | Property::eHostCached);
    } catch (const DeviceError&) {
        return device.memory_type(type_bits, needed);
    }
}

} // namespace

Buffer::Buffer(const Device& device, std::size_t bytes, Memory memory, std::string_view remedy)
    : device_(&device), bytes_(bytes), memory_(memory) {
    const std::uint64_t largest = device.report().max_allocation_bytes;
    if (bytes > largest - 2 * padding) {
        throw_too_large(device, bytes, "largest allocation", largest, remedy);
    }
    const vk::DeviceSize padded = (bytes + padding + padding - 1) / padding * padding;
    try {
        buffer_ = vk::raii::Buffer(device.handle(),
                                   vk::BufferCreateInfo({}, padded, usage_on(device), vk::SharingMode::eExclusive));
        const vk::MemoryRequirements needed = buffer_.getMemoryRequirements();
        const std::uint32_t type =
            memory == Memory::host
                ? host_memory_type(device, needed.memoryTypeBits)
                : device.memory_type(needed.memoryTypeBits, vk::MemoryPropertyFlagBits::eDeviceLocal);
        const vk::PhysicalDeviceMemoryProperties memories = device.physical().getMemoryProperties();
        const std::uint64_t heap = memories.memoryHeaps[memories.memoryTypes[type].heapIndex].size;
        if (needed.size > heap) {
            throw_too_large(device, bytes, "memory", heap, remedy);
        }
        const vk::MemoryAllocateFlagsInfo flags(vk::MemoryAllocateFlagBits::eDeviceAddress);
        allocation_ = vk::raii::DeviceMemory(device.handle(), vk::MemoryAllocateInfo(needed.size, type, &flags));
        const auto taken = static_cast<std::int64_t>(needed.size);
        device.count_memory(taken);
        counted_ = {&device, GiveBackMemory{taken}};
        buffer_.bindMemory(*allocation_, 0);
        if (memory == Memory::host) {
            mapped_ = static_cast<std::byte*>(allocation_.mapMemory(0, VK_WHOLE_SIZE, {}));
        }
    } catch (const vk::SystemError& error) {
        throw run_error_of(
            error,
            fmt::format("{}, asked for {} of its {} bytes,", device.report().name, bytes, device.report().memory_bytes),
            remedy);
    }
}

vk::DeviceAddress Buffer::address() const {
    return device_->handle().getBufferAddress(vk::BufferDeviceAddressInfo(*buffer_));
}

void Buffer::write(std::span<const std::byte> data, std::size_t offset) {
    if (offset > bytes_ || data.size() > bytes_ - offset) {
        throw std::logic_error(fmt::format("write of {} bytes at {} into a buffer of {}", data.size(), offset, bytes_));
    }
    if (data.empty()) {
        return;
    }
    if (mapped_ != nullptr) {
        std::memcpy(mapped_ + offset, data.data(), data.size());
        return;
    }
    const Buffer staging(*device_, std::min(data.size(), staging_bytes), Memory::host);
    for (std::size_t done = 0; done < data.size(); done += staging.bytes()) {
        const std::size_t count = std::min(staging.bytes(), data.size() - done);
        std::memcpy(staging.mapped_, data.data() + done, count);
        Commands commands(*device_);
        commands.copy(staging, *this, count, 0, offset + done);
        commands.submit_and_wait();
    }
}

void Buffer::read(std::span<std::byte> data, std::size_t offset) const {
    if (offset > bytes_ || data.size() > bytes_ - offset) {
        throw std::logic_error(fmt::format("read of {} bytes at {} from a buffer of {}", data.size(), offset, bytes_));
    }
    if (data.empty()) {
        return;
    }
    if (mapped_ != nullptr) {
        std::memcpy(data.data(), mapped_ + offset, data.size());
        return;
    }
    const Buffer staging(*device_, std::min(data.size(), staging_bytes), Memory::host);
    for (std::size_t done = 0; done < data.size(); done += staging.bytes()) {
        const std::size_t count = std::min(staging.bytes(), data.size() - done);
        Commands commands(*device_);
        commands.copy(*this, staging, count, offset + done, 0);
        commands.submit_and_wait();
        std::memcpy(data.data() + done, staging.mapped_, count);
    }
}

std::span<const std::byte> Buffer::mapped() const {
    if (mapped_ == nullptr) {
        throw std::logic_error("the host sees no device memory");
    }
    return {mapped_, bytes_};
}

void Buffer::fill_zero() {
    Commands commands(*device_);
    commands.fill_zero(*this);
    commands.submit_and_wait();
}

} // namespace vkfv::vulkan
