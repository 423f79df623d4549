// Tasks of low priority.
#pragma once

#include <future>
#include <utility>

#include <unistd.h>

namespace vkfv {

// Runs a low-priority task by std::async: its thread, and those that it starts, use the processor time that other
// threads leave.
template <class Task>
auto in_background(Task task) {
    return std::async(std::launch::async, [task = std::move(task)]() mutable {
        constexpr int nicer = 10;
        static_cast<void>(nice(nicer)); // on Linux for the calling thread only
        return task();
    });
}

} // namespace vkfv
