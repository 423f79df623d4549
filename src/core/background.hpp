// Work that gives way to the rest of the program.
#pragma once

#include <sys/resource.h>

#include <future>
#include <utility>

namespace vkfv {

// std::async for what is asked for much later: its thread, and those that it starts, take the cores that others leave.
template <class Task>
auto in_background(Task task) {
    return std::async(std::launch::async, [task = std::move(task)]() mutable {
        constexpr int niceness = 10;
        static_cast<void>(setpriority(PRIO_PROCESS, 0, niceness)); // Linux: of the calling thread
        return task();
    });
}

} // namespace vkfv
