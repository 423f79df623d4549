// Distributes the items of a list among threads.
#pragma once

#include "core/threads/parallel_rows.hpp"

#include <cstddef>
#include <type_traits>
#include <vector>

namespace vkfv {

// Calls task(k) for k = 0 .. count - 1, each on the next free one of at most `most_threads` threads. `task` must not
// throw.
template <class Task>
void parallel_items(int count, const Task& task, int most_threads = core_count()) {
    parallel_bands(
        count, 1, [&](int k, int) { task(k); }, most_threads);
}

// The list of make(k) for k = 0 .. count - 1, in order, computed as by parallel_items(). `make` must not throw.
template <class Make>
auto parallel_list(int count, const Make& make) {
    static_assert(!std::is_same_v<decltype(make(0)), bool>, "threads would share the words of a vector<bool>");
    std::vector<decltype(make(0))> list(static_cast<std::size_t>(count));
    parallel_items(count, [&](int k) { list[static_cast<std::size_t>(k)] = make(k); });
    return list;
}

} // namespace vkfv
