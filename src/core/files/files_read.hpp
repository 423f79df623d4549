// Which files a piece of work reads, so that what comes of it can be kept for as long as they stay as they are.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

struct stat;

namespace vkfv {

// A file as it was: whoever changes it changes one of these, the last even where the time of writing is set back.
struct FileStamp {
    std::string path; // absolute
    std::uint64_t device = 0;
    std::uint64_t number = 0; // of the file on its device
    std::uint64_t bytes = 0;
    std::int64_t changed = 0; // ns since 1970, content or status

    bool operator==(const FileStamp&) const = default;
};

// Whether the file at the path is still that one.
bool is_unchanged(const FileStamp& stamp);

// The files that InputFile has opened since this was made, in whatever thread.
class FilesRead {
  public:
    FilesRead();
    ~FilesRead();
    FilesRead(const FilesRead&) = delete;
    FilesRead& operator=(const FilesRead&) = delete;
    FilesRead(FilesRead&&) = delete;
    FilesRead& operator=(FilesRead&&) = delete;

    // Once each, in the order in which they were opened first.
    std::vector<FileStamp> stamps() const;

  private:
    friend void note_file_read(const std::string& path, const struct ::stat& status);
    std::vector<FileStamp> stamps_;
};

// For InputFile. status: of the open file.
void note_file_read(const std::string& path, const struct ::stat& status);

} // namespace vkfv
