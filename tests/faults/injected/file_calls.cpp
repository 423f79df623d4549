// Preloaded before a program (LD_PRELOAD), fails one of its calls that change files below VKFV_FAULT_FOLDER. The other
// settings are those of plan.hpp; the effects:
//
//   ENOSPC, EIO     nothing happens, and the call says so; a file is closed all the same
//   full            ENOSPC from this call on, of all that needs space
//   short           half is written, and the call says so
//   short-ENOSPC    the same, and then there is no more space
//   lost            half is written, and the call claims that all is
//
// Files that are opened through C's streams are counted as "fopen" and never fail: they have calls of their own within
// libc.
#include "plan.hpp"

#include <cstdarg>
#include <string_view>

#include <climits>
#include <dlfcn.h>
#include <sys/stat.h>
#include <sys/uio.h>

namespace {

using vkfv::faults::is_due;
using vkfv::faults::log_call;
using vkfv::faults::setting;

// The function that would be called without this library; another library's, where a sanitizer stands in for it too.
template <class Function>
Function* next(Function*, const char* name) {
    return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

bool concerns_us(std::string_view path) {
    const std::string_view folder = setting("VKFV_FAULT_FOLDER");
    return !folder.empty() && path.starts_with(folder) && (path.size() == folder.size() || path[folder.size()] == '/');
}

// A path as absolute text; for descriptors the kernel's text, so that none needs to be followed from open() on.
struct Path {
    char text[PATH_MAX + PATH_MAX] = "";

    explicit Path(int file) {
        char link[64];
        std::snprintf(link, sizeof link, "/proc/self/fd/%d", file);
        const ssize_t bytes = ::readlink(link, text, PATH_MAX - 1);
        text[bytes < 0 ? 0 : bytes] = '\0';
    }
    Path(int folder, const char* name) {
        if (name[0] != '/') {
            if (folder != AT_FDCWD) {
                *this = Path(folder);
            } else if (::getcwd(text, PATH_MAX) == nullptr) {
                text[0] = '\0';
            }
            std::strcat(text, "/");
        }
        std::strncat(text, name, PATH_MAX - 1);
    }
};

// Set once there is no more space.
std::atomic<bool> full{false};

bool effect_is(std::string_view effect) {
    return effect == setting("VKFV_FAULT_EFFECT");
}

int error_number() {
    return effect_is("EIO") ? EIO : ENOSPC;
}

// Whether this call is to fail outright; then errno says why.
bool fails(const char* call, const Path& path, std::atomic<long>& count, bool needs_space = true) {
    const int error = errno;
    if (!concerns_us(path.text)) {
        return false;
    }
    const bool due = is_due(call, path.text, count);
    if (due && effect_is("full")) { // else left alone: another thread may fill it just now
        full = true;
    }
    if (due || (full && needs_space)) {
        errno = error_number();
        return true;
    }
    errno = error;
    return false;
}

bool is_for_writing(int flags) {
    return (flags & O_ACCMODE) != O_RDONLY || (flags & O_CREAT) != 0;
}

// Whether a file would be longer: to make it shorter needs no space, on a full disk either.
bool grows(int file, long long bytes) {
    struct stat status {};
    return ::fstat(file, &status) == 0 && bytes > static_cast<long long>(status.st_size);
}

std::atomic<long> opens, writes, syncs, renames, closes, truncations, folders, removals;

// Writes or fails: `write` writes a given number of bytes, `write_all` all of them.
template <class Write, class WriteAll>
ssize_t write_or_fail(int file, std::size_t bytes, Write write, WriteAll write_all) {
    const Path path(file);
    const int error = errno;
    if (!concerns_us(path.text)) {
        errno = error;
        return write_all();
    }
    if (full) {
        log_call("write", path.text);
        errno = ENOSPC;
        return -1;
    }
    if (!is_due("write", path.text, writes)) {
        errno = error;
        return write_all();
    }
    if (effect_is("short") || effect_is("short-ENOSPC") || effect_is("lost")) {
        full = effect_is("short-ENOSPC");
        const ssize_t written = write(bytes / 2);
        return effect_is("lost") && written >= 0 ? static_cast<ssize_t>(bytes) : written;
    }
    full = effect_is("full");
    errno = error_number();
    return -1;
}

} // namespace

// The functions that stand in for libc's; those with 64 in their names are the same functions.
extern "C" {

#define OPEN(name)                                                                                                     \
    int name(const char* path, int flags, ...) {                                                                       \
        std::va_list arguments;                                                                                        \
        va_start(arguments, flags);                                                                                    \
        const mode_t mode = (flags & (O_CREAT | __O_TMPFILE)) != 0 ? va_arg(arguments, mode_t) : 0;                    \
        va_end(arguments);                                                                                             \
        if (is_for_writing(flags) && fails("open", Path(AT_FDCWD, path), opens)) {                                     \
            return -1;                                                                                                 \
        }                                                                                                              \
        return next(::name, #name)(path, flags, mode);                                                                 \
    }
#define OPENAT(name)                                                                                                   \
    int name(int folder, const char* path, int flags, ...) {                                                           \
        std::va_list arguments;                                                                                        \
        va_start(arguments, flags);                                                                                    \
        const mode_t mode = (flags & (O_CREAT | __O_TMPFILE)) != 0 ? va_arg(arguments, mode_t) : 0;                    \
        va_end(arguments);                                                                                             \
        if (is_for_writing(flags) && fails("open", Path(folder, path), opens)) {                                       \
            return -1;                                                                                                 \
        }                                                                                                              \
        return next(::name, #name)(folder, path, flags, mode);                                                         \
    }
#define FOPEN(name)                                                                                                    \
    FILE* name(const char* path, const char* mode) {                                                                   \
        if (const Path whole(AT_FDCWD, path); std::strpbrk(mode, "wa+") != nullptr && concerns_us(whole.text)) {       \
            log_call("fopen", whole.text);                                                                             \
        }                                                                                                              \
        return next(::name, #name)(path, mode);                                                                        \
    }
#define PWRITE(name, offset_type)                                                                                      \
    ssize_t name(int file, const void* data, std::size_t bytes, offset_type at) {                                      \
        const auto some = [&](std::size_t count) { return next(::name, #name)(file, data, count, at); };               \
        return write_or_fail(file, bytes, some, [&] { return some(bytes); });                                          \
    }
#define FTRUNCATE(name, offset_type)                                                                                   \
    int name(int file, offset_type bytes) noexcept {                                                                   \
        return fails("ftruncate", Path(file), truncations, grows(file, bytes)) ? -1                                    \
                                                                               : next(::name, #name)(file, bytes);     \
    }
#define SYNC(name)                                                                                                     \
    int name(int file) {                                                                                               \
        return fails("fsync", Path(file), syncs) ? -1 : next(::name, #name)(file);                                     \
    }

OPEN(open)
OPEN(open64)
OPENAT(openat)
OPENAT(openat64)
FOPEN(fopen)
FOPEN(fopen64)
PWRITE(pwrite, off_t)
PWRITE(pwrite64, off64_t)
FTRUNCATE(ftruncate, off_t)
FTRUNCATE(ftruncate64, off64_t)
SYNC(fsync)
SYNC(fdatasync)

ssize_t write(int file, const void* data, std::size_t bytes) {
    const auto some = [&](std::size_t count) { return next(::write, "write")(file, data, count); };
    return write_or_fail(file, bytes, some, [&] { return some(bytes); });
}

ssize_t writev(int file, const iovec* parts, int count) {
    // Half of the first part is less than the whole.
    return write_or_fail(
        file, count > 0 ? parts[0].iov_len : 0,
        [&](std::size_t bytes) { return next(::write, "write")(file, parts[0].iov_base, bytes); },
        [&] { return next(::writev, "writev")(file, parts, count); });
}

int close(int file) {
    const int flags = ::fcntl(file, F_GETFL);
    const bool fails_now = flags >= 0 && is_for_writing(flags) && fails("close", Path(file), closes, false);
    const int error = errno;
    const int result = next(::close, "close")(file);
    if (fails_now) {
        errno = error;
        return -1;
    }
    return result;
}

int rename(const char* from, const char* to) noexcept {
    return fails("rename", Path(AT_FDCWD, to), renames) ? -1 : next(::rename, "rename")(from, to);
}

int renameat(int from_folder, const char* from, int to_folder, const char* to) noexcept {
    return fails("rename", Path(to_folder, to), renames)
               ? -1
               : next(::renameat, "renameat")(from_folder, from, to_folder, to);
}

int mkdir(const char* path, mode_t mode) noexcept {
    return fails("mkdir", Path(AT_FDCWD, path), folders) ? -1 : next(::mkdir, "mkdir")(path, mode);
}

int mkdirat(int folder, const char* path, mode_t mode) noexcept {
    return fails("mkdir", Path(folder, path), folders) ? -1 : next(::mkdirat, "mkdirat")(folder, path, mode);
}

int unlink(const char* path) noexcept {
    return fails("unlink", Path(AT_FDCWD, path), removals, false) ? -1 : next(::unlink, "unlink")(path);
}

int unlinkat(int folder, const char* path, int flags) noexcept {
    return fails("unlink", Path(folder, path), removals, false) ? -1
                                                                : next(::unlinkat, "unlinkat")(folder, path, flags);
}

} // extern "C"
