// Distributes the rows of an image among threads.
#pragma once

#include "core/threads/threads.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>

namespace vkfv {

// Calls task(first, end) for at most `threads` ranges, one a thread, which cover 0..count once and have nearly equal
// lengths. `task` must not throw.
template <class Task>
void parallel_shares(int count, int threads, const Task& task) {
    const int share = std::max(1, (count + threads - 1) / threads);
    on_threads((count + share - 1) / share,
               [&](int k) { task(k * share, count - k * share < share ? count : (k + 1) * share); });
}

// Calls task(first_row, end_row) for ranges that cover 0..rows once. `task` must not throw, and its result for a row
// must not depend on the range that contains the row. Small images are computed on the calling thread.
template <class Task>
void parallel_rows(int columns, int rows, const Task& task) {
    // Starting a thread takes tens of microseconds, as does touching this many pixels.
    constexpr std::size_t pixels_a_thread = std::size_t{1} << 15;
    const std::size_t pixels = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    const auto threads = std::clamp<std::size_t>(pixels / pixels_a_thread, 1, static_cast<std::size_t>(core_count()));
    parallel_shares(rows, static_cast<int>(threads), task);
}

// Calls task(first_row, end_row) for bands of so many rows, which threads take one after the other: for rows of unequal
// work, and for tasks that need memory for each row.
template <class Task>
void parallel_bands(int rows, int band, const Task& task, int most_threads = core_count()) {
    std::atomic<int> next = 0;
    const int bands = (rows + band - 1) / band;
    on_threads(std::min({bands, core_count(), most_threads}), [&](int) {
        for (int first = band * next++; first < rows; first = band * next++) {
            task(first, std::min(rows, first + band));
        }
    });
}

} // namespace vkfv
