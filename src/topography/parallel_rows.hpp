// Shares the rows of an image among threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <thread>
#include <vector>

namespace vkfv::topography {

// Calls task(first_row, end_row) for ranges that cover 0..rows once. `task` must not throw, and what it
// computes for a row must not depend on the range the row is in. Small images stay on the calling thread.
template <class Task>
void parallel_rows(int columns, int rows, const Task& task) {
    // Starting a thread takes tens of microseconds, as does touching this many pixels.
    constexpr std::size_t pixels_a_thread = std::size_t{1} << 15;
    const std::size_t pixels = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
    const int threads = static_cast<int>(std::clamp<std::size_t>(pixels / pixels_a_thread, 1, cores));
    const int share = (rows + threads - 1) / threads;
    std::vector<std::jthread> others;
    for (int first = share; first < rows; first += share)
        others.emplace_back([&task, first, end = std::min(rows, first + share)] { task(first, end); });
    task(0, std::min(share, rows));
}

} // namespace vkfv::topography
