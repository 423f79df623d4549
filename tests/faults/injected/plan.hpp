// The call that is to fail, and how, are read from the environment by both libraries:
//
//   VKFV_FAULT_CALL     name of the call, "write", "vkQueueSubmit"; without it nothing fails
//   VKFV_FAULT_NUMBER   which of the calls of that name, from 1
//   VKFV_FAULT_LASTS    not empty: all later calls of that name fail too
//   VKFV_FAULT_EFFECT   what becomes of it: see the libraries
//   VKFV_FAULT_LOG      a file to which each counted call is appended, a line of its name and what it concerns
#pragma once

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace vkfv::faults {

inline const char* setting(const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr ? value : "";
}

// Appends a call to the log by system calls, past libc, whose functions one of the libraries stands in for.
inline void log_call(const char* call, const char* subject) {
    const char* log = setting("VKFV_FAULT_LOG");
    if (*log == '\0') {
        return;
    }
    const int error = errno;
    char line[4096 + 64];
    const int bytes = std::snprintf(line, sizeof line, "%s %s\n", call, subject);
    const long file = ::syscall(SYS_openat, AT_FDCWD, log, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (file < 0 || ::syscall(SYS_write, file, line, bytes) != bytes) {
        std::abort(); // a test that counts wrongly would pass
    }
    ::syscall(SYS_close, file);
    errno = error;
}

// Counts this call; returns whether it is the one that is to fail.
inline bool is_due(const char* call, const char* subject, std::atomic<long>& count) {
    log_call(call, subject);
    const long number = ++count;
    const long due = std::atol(setting("VKFV_FAULT_NUMBER"));
    const bool lasts = *setting("VKFV_FAULT_LASTS") != '\0';
    return std::strcmp(setting("VKFV_FAULT_CALL"), call) == 0 && (number == due || (lasts && number > due));
}

} // namespace vkfv::faults
