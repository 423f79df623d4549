// A file that appears under its name only when it is whole.
#pragma once

#include <filesystem>
#include <string_view>

namespace vkfv::surface {

// A hidden name beside the final one. publish() syncs what was written there to disk and renames it; without it
// the destructor removes it. RunError where the disk fails.
class AsideFile {
  public:
    explicit AsideFile(const std::filesystem::path& final_path);
    AsideFile(const AsideFile&) = delete;
    AsideFile& operator=(const AsideFile&) = delete;
    ~AsideFile();
    const std::filesystem::path& path() const { return path_; }
    void publish();

  private:
    std::filesystem::path final_path_;
    std::filesystem::path path_;
};

// The whole file at once, by an AsideFile.
void write_file_aside(const std::filesystem::path& path, std::string_view bytes);

} // namespace vkfv::surface
