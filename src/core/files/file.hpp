// Files: opened only where they are files, read whole, written whole.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv {

// How a message tells of a file that cannot be had.
struct FileRequest {
    std::string key{}; // what named the file: "specimen.file", "--trace-rays"
    std::string expected = "a readable file";
    std::string remedy = "Check the path and its permissions; it is relative to the file that names it.";
};

// A regular file, open for reading. Pipes, sockets, devices and folders are refused by what the open descriptor is, so
// that no reader waits for another program or reads without end, whatever the name means a moment later.
class InputFile {
  public:
    // Throws InputError, with the folder that was searched where there is no such file.
    explicit InputFile(const std::filesystem::path& path, const FileRequest& request = {});

    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;
    ~InputFile();

    std::uint64_t bytes() const { return bytes_; } // when it was opened
    // From the beginning, at most `most` bytes. Throws InputError where the disk fails or the file has become shorter.
    std::string read(std::uint64_t most = UINT64_MAX) const;
    // For libraries that read by themselves: fills `to` from the byte `place` on and returns how many bytes it got,
    // fewer at the end of the file (errno is 0) and where the disk fails (errno says how). The file has no place of its
    // own that a reader could leave elsewhere, so that any number of them, in any threads, read it at once.
    std::size_t read_at(std::uint64_t place, std::span<char> to) const;
    // SHA-256 of all that it holds now, 64 hexadecimal digits. Throws InputError where the disk fails.
    std::string checksum() const;

  private:
    std::filesystem::path path_;
    FileRequest request_;
    int descriptor_ = -1;
    std::uint64_t bytes_ = 0;
};

// All bytes of a regular file. Throws InputError.
std::string read_file(const std::filesystem::path& path, const FileRequest& request = {});

// Under its name there is, at any moment and after any fault, the file of before or this one, whole: written beside it,
// synced, read back and compared, renamed; then the folder is synced. Programs that write the same file take turns. A
// link is followed; what is no regular file is not replaced. Throws RunError, with the reason and the remedy.
void write_file(const std::filesystem::path& path, std::string_view bytes);

// The same for a file that may be larger than the memory: `parts` hands its bytes over in order, and what is read back
// is compared by its checksum, which is returned (SHA-256, 64 hexadecimal digits). What `parts` throws leaves the file
// of before.
using AddBytes = std::function<void(std::string_view)>;
std::string write_file_in_parts(const std::filesystem::path& path, const std::function<void(const AddBytes&)>& parts);

// SHA-256 of a regular file of any size. Throws InputError.
std::string checksum_of_file(const std::filesystem::path& path);

// A line at the end of a text file that others watch; not synced. Throws RunError.
void append_line(const std::filesystem::path& path, std::string_view line);

// With the folders above it, each entered durably in its parent. Throws RunError.
void make_folder(const std::filesystem::path& folder);

// Removes what programs that are no more had begun to write into this folder (not below it). Throws RunError.
void remove_unfinished_files(const std::filesystem::path& folder);

// Of a file that write_file() has begun: hidden, beside the final one.
bool is_unfinished_file(const std::filesystem::path& path);

} // namespace vkfv
