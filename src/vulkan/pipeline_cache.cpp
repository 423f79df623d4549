#include "vulkan/pipeline_cache.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <system_error>
#include <unistd.h>

namespace vkfv::vulkan {

namespace {

constexpr std::array<char, 16> file_mark = {'v', 'k', 'f', 'v', ' ', 'p', 'i', 'p', 'e', 'l', 'i', 'n', 'e', 's', ' ', '1'};
// A file of many instruments' kernels is begun anew rather than read beyond this.
constexpr std::uintmax_t most_bytes = std::uintmax_t{64} << 20;

struct Header {
    std::array<char, file_mark.size()> mark;
    std::uint64_t bytes;
    std::uint64_t checksum;
};

// FNV-1a (RFC 9923): a driver need not survive data that it did not write.
std::uint64_t checksum(std::span<const std::byte> data) {
    std::uint64_t hash = 0xCBF29CE484222325U;
    for (const std::byte byte : data) {
        hash = (hash ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001B3U;
    }
    return hash;
}

} // namespace

std::optional<std::filesystem::path> cache_folder() {
    const auto given = [](const char* variable) -> std::optional<std::filesystem::path> {
        const char* value = std::getenv(variable);
        // The XDG base directory specification: relative paths are to be ignored.
        if (value == nullptr || !std::filesystem::path(value).is_absolute()) {
            return std::nullopt;
        }
        return value;
    };
    if (const auto cache = given("XDG_CACHE_HOME")) {
        return *cache / "vkfv";
    }
    if (const auto home = given("HOME")) {
        return *home / ".cache" / "vkfv";
    }
    return std::nullopt;
}

std::vector<std::byte> read_cached(std::string_view name) {
    const auto folder = cache_folder();
    std::error_code failed;
    if (!folder) {
        return {};
    }
    const auto path = *folder / name;
    const std::uintmax_t bytes = std::filesystem::file_size(path, failed);
    if (failed || bytes < sizeof(Header) || bytes > most_bytes) {
        return {};
    }
    std::ifstream file(path, std::ios::binary);
    Header header{};
    std::vector<std::byte> data(bytes - sizeof(Header));
    file.read(reinterpret_cast<char*>(&header), sizeof header);
    file.read(reinterpret_cast<char*>(data.data()), static_cast<std::streamsize>(data.size()));
    if (!file || header.mark != file_mark || header.bytes != data.size() || header.checksum != checksum(data)) {
        return {};
    }
    return data;
}

void write_cached(std::string_view name, std::span<const std::byte> data) {
    const auto folder = cache_folder();
    std::error_code failed;
    if (!folder || (std::filesystem::create_directories(*folder, failed), failed)) {
        return;
    }
    const auto aside = *folder / fmt::format("{}.{}", name, getpid());
    const Header header{file_mark, data.size(), checksum(data)};
    bool written = false;
    {
        std::ofstream file(aside, std::ios::binary);
        file.write(reinterpret_cast<const char*>(&header), sizeof header);
        file.write(reinterpret_cast<const char*>(data.data()), static_cast<std::streamsize>(data.size()));
        file.close();
        written = !file.fail();
    }
    if (written) {
        std::filesystem::rename(aside, *folder / name, failed);
    }
    if (!written || failed) {
        std::filesystem::remove(aside, failed);
    }
}

} // namespace vkfv::vulkan
