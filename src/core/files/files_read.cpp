#include "core/files/files_read.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <mutex>

namespace vkfv {

namespace {

std::mutex readers_mutex; // guards the list of readers and their own lists
std::vector<FilesRead*> readers;

FileStamp stamp_of(std::string path, const struct stat& status) {
    constexpr std::int64_t ns_per_s = 1'000'000'000;
    return {.path = std::move(path),
            .device = static_cast<std::uint64_t>(status.st_dev),
            .number = static_cast<std::uint64_t>(status.st_ino),
            .bytes = static_cast<std::uint64_t>(status.st_size),
            .changed = std::int64_t{status.st_ctim.tv_sec} * ns_per_s + status.st_ctim.tv_nsec};
}

} // namespace

bool is_unchanged(const FileStamp& stamp) {
    struct stat status {};
    return ::stat(stamp.path.c_str(), &status) == 0 && stamp_of(stamp.path, status) == stamp;
}

FilesRead::FilesRead() {
    const std::scoped_lock lock(readers_mutex);
    readers.push_back(this);
}

FilesRead::~FilesRead() {
    const std::scoped_lock lock(readers_mutex);
    std::erase(readers, this);
}

std::vector<FileStamp> FilesRead::stamps() const {
    const std::scoped_lock lock(readers_mutex);
    return stamps_;
}

void note_file_read(const std::string& path, const struct stat& status) {
    const std::scoped_lock lock(readers_mutex);
    if (readers.empty()) {
        return;
    }
    std::error_code none;
    const FileStamp stamp = stamp_of(std::filesystem::absolute(path, none).string(), status);
    for (FilesRead* reader : readers) {
        if (std::ranges::find(reader->stamps_, stamp) == reader->stamps_.end()) {
            reader->stamps_.push_back(stamp);
        }
    }
}

} // namespace vkfv
