// Work that gives way to the rest of the program.
#pragma once

#include <future>
#include <utility>

#include <unistd.h>

namespace vkfv {

// std::async for what is asked for much later: its thread, and those that it starts, take the cores that others leave.
template <class Task>
auto in_background(Task task) {
    return std::async(std::launch::async, [task = std::move(task)]() mutable {
        constexpr int nicer = 10;
        static_cast<void>(nice(nicer)); // Linux: the calling thread alone
        return task();
    });
}

} // namespace vkfv
