// Shares the items of a list among threads.
#pragma once

#include "core/threads/parallel_rows.hpp"

#include <cstddef>
#include <type_traits>
#include <vector>

namespace vkfv {

// task(k) for k = 0 .. count - 1, each by whichever thread is free, of which there are at most `most_threads`. `task`
// must not throw.
template <class Task>
void parallel_items(int count, const Task& task, int most_threads = core_count()) {
    parallel_bands(
        count, 1, [&](int k, int) { task(k); }, most_threads);
}

// make(k) for k = 0 .. count - 1, likewise; in order. `make` must not throw.
template <class Make>
auto parallel_list(int count, const Make& make) {
    static_assert(!std::is_same_v<decltype(make(0)), bool>, "threads would share the words of a vector<bool>");
    std::vector<decltype(make(0))> list(static_cast<std::size_t>(count));
    parallel_items(count, [&](int k) { list[static_cast<std::size_t>(k)] = make(k); });
    return list;
}

} // namespace vkfv
