#include "trace/device/device_numbers.hpp"

#include <algorithm>
#include <stdexcept>

namespace vkfv::trace {

namespace {

constexpr std::size_t most_staging_bytes = std::size_t{64} << 20; // sorted light takes gigabytes

} // namespace

DeviceNumbers::DeviceNumbers(const vulkan::Device& device, std::vector<const vulkan::Buffer*> buffers)
    : device_(&device), buffers_(std::move(buffers)) {
    for (const auto* buffer : buffers_) {
        bytes_ += buffer->bytes();
    }
}

vulkan::Buffer& DeviceNumbers::staging() const {
    if (!staging_) {
        staging_.emplace(*device_, std::min(bytes_, most_staging_bytes), vulkan::Buffer::Memory::host);
    }
    return *staging_;
}

std::vector<std::uint64_t> DeviceNumbers::read(ExposureWork& work) const {
    if (bytes_ == 0) {
        return {};
    }
    const vulkan::Buffer& to = staging();
    std::vector<std::uint64_t> numbers;
    numbers.reserve(count());
    for (const auto& load : loads(to.bytes())) {
        vulkan::Commands& commands = work.open();
        std::size_t place = 0;
        for (const Piece& piece : load) {
            commands.copy(*piece.buffer, to, piece.bytes, piece.first_byte, place);
            place += piece.bytes;
        }
        work.submit();
        work.wait();
        const auto loaded = to.values<std::uint64_t>(place / sizeof(std::uint64_t));
        numbers.insert(numbers.end(), loaded.begin(), loaded.end());
    }
    return numbers;
}

void DeviceNumbers::write(ExposureWork& work, std::span<const std::uint64_t> numbers) const {
    if (numbers.size() != count()) {
        throw std::logic_error("numbers of another exposure");
    }
    if (bytes_ == 0) { // an exposure begins with a submission even if it has no numbers
        work.open();
        work.submit();
        work.wait();
        return;
    }
    std::size_t done = 0;
    for (const auto& load : loads(staging().bytes())) {
        std::size_t bytes = 0;
        for (const Piece& piece : load) {
            bytes += piece.bytes;
        }
        const std::size_t loaded = bytes / sizeof(std::uint64_t);
        staging().write_values(numbers.subspan(done, loaded));
        done += loaded;
        vulkan::Commands& commands = work.open();
        std::size_t place = 0;
        for (const Piece& piece : load) {
            commands.copy(staging(), *piece.buffer, piece.bytes, place, piece.first_byte);
            place += piece.bytes;
        }
        work.submit();
        work.wait(); // because the staging memory is written again
    }
}

std::vector<std::vector<DeviceNumbers::Piece>> DeviceNumbers::loads(std::size_t most_bytes) const {
    std::vector<std::vector<Piece>> all;
    std::size_t room = 0;
    for (const auto* buffer : buffers_) {
        for (std::size_t first = 0; first < buffer->bytes();) {
            if (room == 0) {
                all.emplace_back();
                room = most_bytes;
            }
            const std::size_t bytes = std::min(room, buffer->bytes() - first);
            all.back().push_back({.buffer = buffer, .first_byte = first, .bytes = bytes});
            first += bytes;
            room -= bytes;
        }
    }
    return all;
}

} // namespace vkfv::trace
