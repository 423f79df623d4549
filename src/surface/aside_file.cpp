#include "surface/aside_file.hpp"

#include "core/error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <system_error>

namespace vkfv::surface {
namespace {

// Makes a file's content or a folder's entries durable.
void sync_to_disk(const std::filesystem::path& path) {
    const int descriptor = ::open(path.c_str(), O_RDONLY);
    const bool synced = descriptor >= 0 && ::fsync(descriptor) == 0;
    const int error = errno;
    if (descriptor >= 0)
        ::close(descriptor);
    if (!synced)
        throw RunError(fmt::format("{}: cannot be synced to disk: {}", path.string(),
                                   std::generic_category().message(error)));
}

} // namespace

AsideFile::AsideFile(const std::filesystem::path& final_path) : final_path_(final_path), path_(final_path) {
    path_.replace_filename(fmt::format(".{}.part", final_path.filename().string()));
}

AsideFile::~AsideFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
}

void AsideFile::publish() {
    sync_to_disk(path_);
    std::error_code error;
    std::filesystem::rename(path_, final_path_, error);
    if (error)
        throw RunError(fmt::format("{}: cannot be renamed to {}: {}", path_.string(), final_path_.string(),
                                   error.message()));
    const auto folder = final_path_.parent_path();
    sync_to_disk(folder.empty() ? std::filesystem::path(".") : folder);
}

void write_file_aside(const std::filesystem::path& path, std::string_view bytes) {
    AsideFile aside(path);
    std::ofstream stream(aside.path(), std::ios::binary);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size())).flush();
    if (!stream)
        throw RunError(fmt::format("{}: cannot be written. Free space on the disk, check its permissions, and "
                                   "run the same command again.",
                                   path.string()));
    stream.close();
    aside.publish();
}

} // namespace vkfv::surface
