// Files: only regular ones are opened, and they are read whole and written whole.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv {

// The wording of the message about a file that cannot be opened or read.
struct FileRequest {
    std::string key{}; // key or option that named the file: "specimen.file", "--trace-rays"
    std::string expected = "a readable file";
    std::string remedy = "Check the path and its permissions; it is relative to the file that names it.";
};

// A regular file, open for reading. Pipes, sockets, devices and folders are refused by the type of the open descriptor,
// so that no reader waits for another program or reads without end, even if the name is given to another file
// afterwards.
class InputFile {
  public:
    // Opens a file. Throws InputError, with the folder that was searched if there is no such file.
    explicit InputFile(const std::filesystem::path& path, const FileRequest& request = {});

    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;
    ~InputFile();

    std::uint64_t bytes() const { return bytes_; } // size when it was opened
    // Reads from the beginning, at most `most` bytes. Throws InputError if the disk fails or the file has become
    // shorter.
    std::string read(std::uint64_t most = UINT64_MAX) const;
    // Reads for libraries: fills `to` from the byte `place` and returns the number of bytes read, fewer at the end of
    // the file (errno is 0) and if the disk fails (errno has the reason). The file has no position that readers share,
    // so any number of them may read in any threads.
    std::size_t read_at(std::uint64_t place, std::span<char> to) const;
    // SHA-256 of the current content, 64 hexadecimal digits. Throws InputError if the disk fails.
    std::string checksum() const;

  private:
    std::filesystem::path path_;
    FileRequest request_;
    int descriptor_ = -1;
    std::uint64_t bytes_ = 0;
};

// Reads all bytes of a regular file. Throws InputError.
std::string read_file(const std::filesystem::path& path, const FileRequest& request = {});

// Writes a file atomically: at any moment and after any fault, its name holds the previous file or the complete new
// one. The bytes are written beside it, synced, read back and compared, then renamed; then the folder is synced.
// Programs that write the same file take turns. A link is followed; a file that is not regular is not replaced. Throws
// RunError, with the reason and the remedy.
void write_file(const std::filesystem::path& path, std::string_view bytes);

// Writes a file like write_file(), which may be larger than the memory: `parts` passes its bytes in order, and the
// content read back is compared by its checksum, which is returned (SHA-256, 64 hexadecimal digits). If `parts` throws,
// the previous file remains.
using AddBytes = std::function<void(std::string_view)>;
std::string write_file_in_parts(const std::filesystem::path& path, const std::function<void(const AddBytes&)>& parts);

// SHA-256 of a regular file of any size. Throws InputError.
std::string checksum_of_file(const std::filesystem::path& path);

// Appends a line to a text file that others watch; it is not synced. Throws RunError.
void append_line(const std::filesystem::path& path, std::string_view line);

// Makes a folder and those above it, each synced in its parent. Throws RunError.
void make_folder(const std::filesystem::path& folder);

// Removes the unfinished files that ended programs left in this folder (not below it). Throws RunError.
void remove_unfinished_files(const std::filesystem::path& folder);

// True for the name of an unfinished file of write_file(), which is hidden beside the final one.
bool is_unfinished_file(const std::filesystem::path& path);

} // namespace vkfv
