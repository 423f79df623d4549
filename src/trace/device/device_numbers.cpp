#include "trace/device/device_numbers.hpp"

namespace vkfv::trace {

DeviceNumbers::DeviceNumbers(const vulkan::Device& device, std::vector<const vulkan::Buffer*> buffers)
    : device_(&device), buffers_(std::move(buffers)) {
    for (const auto* buffer : buffers_) {
        bytes_ += buffer->bytes();
    }
}

vulkan::Buffer& DeviceNumbers::staging() const {
    if (!staging_) {
        staging_.emplace(*device_, bytes_, vulkan::Buffer::Memory::host);
    }
    return *staging_;
}

std::vector<std::uint64_t> DeviceNumbers::read(ExposureWork& work) const {
    if (bytes_ == 0) {
        return {};
    }
    const vulkan::Buffer& to = staging();
    vulkan::Commands& commands = work.open();
    std::size_t place = 0;
    for (const auto* buffer : buffers_) {
        commands.copy(*buffer, to, buffer->bytes(), 0, place);
        place += buffer->bytes();
    }
    work.submit();
    work.wait();
    const auto numbers = to.values<std::uint64_t>(count());
    return {numbers.begin(), numbers.end()};
}

void DeviceNumbers::write(ExposureWork& work, std::span<const std::uint64_t> numbers) const {
    if (bytes_ > 0) {
        staging().write_values(numbers);
    }
    vulkan::Commands& commands = work.open(); // also of nothing: it is what the exposure begins with
    std::size_t place = 0;
    for (const auto* buffer : buffers_) {
        commands.copy(staging(), *buffer, buffer->bytes(), place);
        place += buffer->bytes();
    }
    work.submit();
    work.wait(); // the staging memory is written again
}

} // namespace vkfv::trace
