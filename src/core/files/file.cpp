#include "core/files/file.hpp"

#include "core/files/digest.hpp"
#include "core/files/files_read.hpp"
#include "core/messages/error.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <optional>
#include <system_error>
#include <utility>

namespace vkfv {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view unfinished_suffix = ".part";

std::string reason_of(int error) {
    return std::generic_category().message(error);
}

// The kind of a file that is not regular, for messages; empty for a regular file.
std::string kind_of(const struct stat& status) {
    switch (status.st_mode & S_IFMT) {
    case S_IFREG:
        return "";
    case S_IFDIR:
        return "a directory";
    case S_IFIFO:
        return "a named pipe";
    case S_IFSOCK:
        return "a socket";
    default:
        return "a device";
    }
}

// Closes a file descriptor at the end of its scope.
class Descriptor {
  public:
    explicit Descriptor(int number) : number_(number) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (number_ >= 0) {
            ::close(number_);
        }
    }
    int number() const { return number_; }
    bool open() const { return number_ >= 0; }
    int release() { return std::exchange(number_, -1); }
    // False if the disk reports an error only now, for data that it had accepted.
    bool close() { return ::close(release()) == 0; }

  private:
    int number_;
};

[[noreturn]] void fail(const fs::path& path, std::string_view what, std::string_view reason) {
    throw RunError(
        fmt::format("{}: {}: {}. Check the path, its permissions and the free space, and run the same command again",
                    path.string(), what, reason));
}

[[noreturn]] void fail_to_write(const fs::path& path, int error) {
    fail(path, "cannot be written", reason_of(error));
}

bool write_all(int file, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(file, bytes.data(), bytes.size());
        if (written > 0) {
            bytes.remove_prefix(static_cast<std::size_t>(written));
        } else if (written == 0 || errno != EINTR) {
            errno = written == 0 ? EIO : errno;
            return false;
        }
    }
    return true;
}

// True if the file holds these bytes and no others.
bool holds(int file, std::string_view bytes) {
    struct stat status {};
    if (::fstat(file, &status) != 0 || static_cast<std::uint64_t>(status.st_size) != bytes.size()) {
        return false;
    }
    std::vector<char> block(std::size_t{1} << 20);
    for (std::size_t done = 0; done < bytes.size();) {
        const ssize_t got = ::pread(file, block.data(), block.size(), static_cast<off_t>(done));
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got <= 0 || std::string_view(block.data(), static_cast<std::size_t>(got)) !=
                            bytes.substr(done, static_cast<std::size_t>(got))) {
            return false;
        }
        done += static_cast<std::size_t>(got);
    }
    return true;
}

// SHA-256 of the whole file; none if reading fails, with the reason in errno.
std::optional<std::string> checksum(int file) {
    Digest digest;
    std::vector<char> block(std::size_t{1} << 20);
    for (off_t done = 0;;) {
        const ssize_t got = ::pread(file, block.data(), block.size(), done);
        if (got == 0) {
            return digest.sha256();
        }
        if (got > 0) {
            digest.add(std::string_view(block.data(), static_cast<std::size_t>(got)));
            done += got;
        } else if (errno != EINTR) {
            return std::nullopt;
        }
    }
}

// Syncs a folder. Errors of file systems that cannot sync folders are ignored: they make renames as durable as they
// can.
void sync_folder(const fs::path& folder) {
    const Descriptor file(::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (!file.open() || (::fsync(file.number()) != 0 && errno != EINVAL && errno != ENOTSUP)) {
        fail(folder, "cannot be synced to disk", reason_of(errno));
    }
}

fs::path unfinished_path(const fs::path& path) {
    fs::path beside = path;
    beside.replace_filename(fmt::format(".{}{}", path.filename().string(), unfinished_suffix));
    return beside;
}

bool same_file(int file, const fs::path& path) {
    struct stat open_one {
    }, named_one{};
    return ::fstat(file, &open_one) == 0 && ::lstat(path.c_str(), &named_one) == 0 &&
           open_one.st_dev == named_one.st_dev && open_one.st_ino == named_one.st_ino;
}

// Opens the unfinished file, empty and locked: programs that write the same file wait here for each other. The kernel
// releases the lock when the process ends.
int open_unfinished(const fs::path& beside, const fs::path& path) {
    for (;;) {
        Descriptor file(::open(beside.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666));
        if (!file.open()) {
            fail_to_write(path, errno);
        }
        while (::flock(file.number(), LOCK_EX) != 0 && errno == EINTR) {
        }
        // The program that held the lock may have renamed the file meanwhile; then the name is opened again.
        if (same_file(file.number(), beside)) {
            struct stat status {};
            if (::fstat(file.number(), &status) == 0 && status.st_nlink > 1) {
                ::unlink(beside.c_str()); // it has another name too, whose content must not be removed
                continue;
            }
            if (::ftruncate(file.number(), 0) != 0) {
                fail_to_write(path, errno);
            }
            return file.release();
        }
    }
}

// The place of the bytes: links are resolved, and files that are not regular, which a rename would destroy, are
// refused.
fs::path target_of(const fs::path& path) {
    std::error_code none;
    const fs::path target = fs::is_symlink(path, none) ? fs::weakly_canonical(path, none) : path;
    struct stat status {};
    if (target.empty() || target.filename().empty()) {
        fail(path, "cannot be written", "it names no file");
    }
    if (::stat(target.c_str(), &status) == 0) {
        if (const std::string kind = kind_of(status); !kind.empty()) {
            fail(path, "cannot be written", "it is " + kind);
        }
    }
    return target;
}

constexpr std::string_view not_returned = "the disk does not return what was written";

// Writes a file by way of an unfinished one beside it. fill: writes and syncs the unfinished file and returns the
// reason of a failure; empty: success.
void replace_file(const fs::path& path, const std::function<std::string(int)>& fill) {
    const fs::path target = target_of(path);
    const fs::path beside = unfinished_path(target);
    Descriptor file(open_unfinished(beside, path));
    std::string reason;
    try {
        reason = fill(file.number());
    } catch (...) {
        ::unlink(beside.c_str());
        throw;
    }
    if (reason.empty() && ::rename(beside.c_str(), target.c_str()) != 0) {
        reason = fmt::format("it cannot be renamed from {}: {}", beside.filename().string(), reason_of(errno));
    }
    if (!reason.empty()) {
        ::unlink(beside.c_str());
        fail(path, "cannot be written", reason);
    }
    if (!file.close()) {
        fail_to_write(path, errno);
    }
    sync_folder(target.parent_path());
}

} // namespace

InputFile::InputFile(const fs::path& path, const FileRequest& request) : path_(path), request_(request) {
    const auto refuse = [&](std::string found) {
        throw InputError({.where = {.file = path},
                          .key = request.key,
                          .found = std::move(found),
                          .expected = request.expected,
                          .remedy = request.remedy});
    };
    if (path.empty()) {
        refuse("an empty name");
    }
    // O_NONBLOCK: opening a pipe must not wait for its writer.
    Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
    if (!file.open()) {
        const int error = errno;
        if (error == ENOENT) {
            std::error_code none;
            const fs::path folder = fs::absolute(path, none).lexically_normal().parent_path();
            refuse(fs::is_directory(folder, none) ? "no such file"
                                                  : fmt::format("no such file, nor a folder {}", folder.string()));
        }
        refuse(error == ENXIO ? "a socket" : reason_of(error));
    }
    struct stat status {};
    if (::fstat(file.number(), &status) != 0) {
        refuse(reason_of(errno));
    }
    if (const std::string kind = kind_of(status); !kind.empty()) {
        refuse(kind);
    }
    note_file_read(path.string(), status);
    bytes_ = static_cast<std::uint64_t>(status.st_size);
    descriptor_ = file.release();
}

InputFile::~InputFile() {
    ::close(descriptor_);
}

std::string InputFile::read(std::uint64_t most) const {
    std::string bytes(std::min(most, bytes_), '\0');
    const std::size_t done = read_at(0, bytes);
    if (done < bytes.size()) {
        throw InputError({.where = {.file = path_, .line = 0, .column = 0, .byte_offset = done},
                          .key = request_.key,
                          .found = errno == 0 ? "the end of the file" : reason_of(errno),
                          .expected = fmt::format("{} bytes", bytes_),
                          .remedy = "Check the disk, and that no other program writes the file."});
    }
    return bytes;
}

std::size_t InputFile::read_at(std::uint64_t place, std::span<char> to) const {
    std::size_t done = 0;
    while (done < to.size()) {
        const ssize_t got = ::pread(descriptor_, to.data() + done, to.size() - done, static_cast<off_t>(place + done));
        if (got > 0) {
            done += static_cast<std::size_t>(got);
        } else if (got == 0) {
            errno = 0;
            break;
        } else if (errno != EINTR) {
            break;
        }
    }
    return done;
}

std::string InputFile::checksum() const {
    const auto sum = vkfv::checksum(descriptor_);
    if (!sum) {
        refuse_file(path_, "", reason_of(errno), "a file that can be read", "Check the disk.");
    }
    return *sum;
}

std::string read_file(const fs::path& path, const FileRequest& request) {
    return InputFile(path, request).read();
}

void write_file(const fs::path& path, std::string_view bytes) {
    replace_file(path, [&](int file) {
        if (!write_all(file, bytes) || ::fsync(file) != 0) {
            return reason_of(errno);
        }
        return holds(file, bytes) ? std::string() : std::string(not_returned);
    });
}

std::string write_file_in_parts(const fs::path& path, const std::function<void(const AddBytes&)>& parts) {
    Digest digest;
    replace_file(path, [&](int file) {
        parts([&](std::string_view bytes) {
            if (!write_all(file, bytes)) {
                fail_to_write(path, errno);
            }
            digest.add(bytes);
        });
        if (::fsync(file) != 0) {
            return reason_of(errno);
        }
        return checksum(file) == digest.sha256() ? std::string() : std::string(not_returned);
    });
    return digest.sha256();
}

std::string checksum_of_file(const fs::path& path) {
    return InputFile(path).checksum();
}

void append_line(const fs::path& path, std::string_view line) {
    (void)target_of(path);
    Descriptor file(::open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0666));
    struct stat before {};
    if (!file.open() || ::fstat(file.number(), &before) != 0) {
        fail_to_write(path, errno);
    }
    if (!write_all(file.number(), std::string(line) + "\n")) {
        const int error = errno;
        (void)!::ftruncate(file.number(), before.st_size); // others must not read half a line
        fail_to_write(path, error);
    }
    if (!file.close()) {
        fail_to_write(path, errno);
    }
}

void make_folder(const fs::path& folder) {
    std::error_code error;
    if (folder.empty() || fs::is_directory(folder, error)) {
        return;
    }
    fs::path whole = folder.lexically_normal();
    whole = whole.has_filename() ? whole : whole.parent_path();
    make_folder(whole.parent_path());
    // mkdir() may fail because another program has made the folder meanwhile.
    if (::mkdir(whole.c_str(), 0777) != 0) {
        const int reason = errno; // saved, as the next call may change errno
        if (!fs::is_directory(whole, error)) {
            fail(folder, "cannot be made", reason_of(reason == EEXIST ? ENOTDIR : reason));
        }
    }
    sync_folder(whole.parent_path());
}

bool is_unfinished_file(const fs::path& path) {
    const std::string name = path.filename().string();
    return name.starts_with('.') && name.ends_with(unfinished_suffix);
}

void remove_unfinished_files(const fs::path& folder) {
    std::error_code error;
    std::vector<fs::path> unfinished;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        std::error_code none;
        if (is_unfinished_file(entry->path()) && entry->is_regular_file(none)) {
            unfinished.push_back(entry->path());
        }
    }
    if (error) {
        fail(folder, "cannot be listed", error.message());
    }
    for (const fs::path& path : unfinished) {
        const Descriptor file(::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
        if (file.open() && ::flock(file.number(), LOCK_EX | LOCK_NB) == 0 && ::unlink(path.c_str()) != 0 &&
            errno != ENOENT) {
            fail(path, "cannot be removed", reason_of(errno));
        }
    }
}

} // namespace vkfv
