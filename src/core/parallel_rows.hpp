// Shares the rows of an image among threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace vkfv {

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

// The same in bands of so many rows, which threads take one after the other: for rows that differ in their work, and
// for tasks that take memory a row.
template <class Task>
void parallel_bands(int rows, int band, const Task& task) {
    std::atomic<int> next = 0;
    const auto work = [&] {
        for (int first = band * next++; first < rows; first = band * next++) {
            task(first, std::min(rows, first + band));
        }
    };
    const int bands = (rows + band - 1) / band;
    const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    std::vector<std::jthread> others;
    for (int k = 1; k < std::min(bands, cores); ++k) {
        others.emplace_back(work);
    }
    work();
}

} // namespace vkfv
