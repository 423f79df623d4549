// Shares the items of a list among threads.
#pragma once

#include "core/parallel_rows.hpp"

#include <cstddef>
#include <type_traits>
#include <vector>

namespace vkfv {

// make(k) for k = 0 .. count - 1, each by whichever thread is free; in order. `make` must not throw.
template <class Make>
auto parallel_list(int count, const Make& make) {
    static_assert(!std::is_same_v<decltype(make(0)), bool>, "threads would share the words of a vector<bool>");
    std::vector<decltype(make(0))> list(static_cast<std::size_t>(count));
    parallel_bands(count, 1, [&](int first, int end) {
        for (int k = first; k < end; ++k) {
            list[static_cast<std::size_t>(k)] = make(k);
        }
    });
    return list;
}

} // namespace vkfv
