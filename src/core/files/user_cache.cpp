#include "core/files/user_cache.hpp"

#include "core/files/digest.hpp"
#include "core/files/file.hpp"
#include "core/messages/error.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <system_error>
#include <utility>

namespace vkfv {

namespace {

constexpr std::string_view file_mark = "vkfv cache 3\n";
constexpr std::size_t checksum_digits = 64;
// A larger file, with the kernels of many instruments, is not read but begun anew.
constexpr std::size_t most_bytes = std::size_t{64} << 20;

// The checksum protects drivers, which may crash on data that they did not write, and readers from data that the disk
// has changed.
std::string checksum(std::span<const std::byte> data) {
    return Digest().add(data).sha256();
}

} // namespace

std::optional<std::filesystem::path> cache_folder() {
    const auto given = [](const char* variable) -> std::optional<std::filesystem::path> {
        const char* value = std::getenv(variable);
        // The XDG base directory specification requires that relative paths are ignored.
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
    std::error_code none;
    if (!folder || !std::filesystem::exists(*folder / name, none)) {
        return {};
    }
    std::string bytes;
    try {
        bytes = InputFile(*folder / name).read(most_bytes);
    } catch (const InputError&) {
        return {};
    }
    const std::size_t head = file_mark.size() + checksum_digits;
    if (bytes.size() < head || !bytes.starts_with(file_mark)) {
        return {};
    }
    const auto data = std::as_bytes(std::span(bytes).subspan(head));
    if (checksum(data) != bytes.substr(file_mark.size(), checksum_digits)) {
        return {};
    }
    return {data.begin(), data.end()};
}

void write_cached(std::string_view name, std::span<const std::byte> data) {
    const auto folder = cache_folder();
    if (!folder) {
        return;
    }
    std::string bytes = std::string(file_mark) + checksum(data);
    bytes.append(reinterpret_cast<const char*>(data.data()), data.size());
    // The file is not synced: one damaged by a power failure is recognized by its checksum.
    std::error_code failed;
    std::filesystem::create_directories(*folder, failed);
    static std::atomic<unsigned> writes = 0; // distinguishes threads that write the same file
    const auto aside = *folder / fmt::format("{}.part-{}-{}", name, ::getpid(), writes++);
    if (std::ofstream file(aside, std::ios::binary); !file.write(bytes.data(), std::ssize(bytes)) || !file.flush()) {
        std::filesystem::remove(aside, failed);
        return;
    }
    std::filesystem::rename(aside, *folder / name, failed);
    if (failed) {
        std::filesystem::remove(aside, failed);
    }
}

void thin_out_cached(std::string_view beginning, std::size_t most) {
    namespace fs = std::filesystem;
    const auto folder = cache_folder();
    if (!folder) {
        return;
    }
    std::error_code none; // ignored: another process may remove files at the same time
    std::vector<std::pair<fs::file_time_type, fs::path>> files;
    for (fs::directory_iterator entry(*folder, none), end; entry != end; entry.increment(none)) {
        if (entry->path().filename().string().starts_with(beginning)) {
            files.emplace_back(entry->last_write_time(none), entry->path());
        }
    }
    std::ranges::sort(files, std::greater{});
    for (std::size_t k = most; k < files.size(); ++k) {
        fs::remove(files[k].second, none);
    }
}

} // namespace vkfv
