// Records the files that a computation reads, so that its results can be kept as long as these files do not change.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

struct stat;

namespace vkfv {

// The state of a file. Every change to the file alters one of these members; `changed` even if the time of modification
// is set back.
struct FileStamp {
    std::string path; // absolute path
    std::uint64_t device = 0;
    std::uint64_t number = 0; // inode on the device
    std::uint64_t bytes = 0;
    std::int64_t changed = 0; // ns since 1970, change of content or status

    bool operator==(const FileStamp&) const = default;
};

// True if the file at the path has still this state.
bool is_unchanged(const FileStamp& stamp);

// Collects the files that InputFile opens, in any thread, during the object's life.
class FilesRead {
  public:
    FilesRead();
    ~FilesRead();
    FilesRead(const FilesRead&) = delete;
    FilesRead& operator=(const FilesRead&) = delete;
    FilesRead(FilesRead&&) = delete;
    FilesRead& operator=(FilesRead&&) = delete;

    // The files, once each, in the order in which they were first opened.
    std::vector<FileStamp> stamps() const;

  private:
    friend void note_file_read(const std::string& path, const struct ::stat& status);
    std::vector<FileStamp> stamps_;
};

// Called by InputFile. status: of the open file.
void note_file_read(const std::string& path, const struct ::stat& status);

} // namespace vkfv
