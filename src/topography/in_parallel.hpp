#pragma once

#include <algorithm>
#include <atomic>
#include <limits>
#include <thread>
#include <vector>

namespace vkfv::topography {

// Calls task(k) for 0 .. count - 1, on all cores or fewer threads; tasks may be of unequal length.
template <class Task>
void in_parallel(int count, const Task& task, int most_threads = std::numeric_limits<int>::max()) {
    std::atomic<int> next = 0;
    const auto work = [&] {
        for (int k = next++; k < count; k = next++) {
            task(k);
        }
    };
    const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    const int threads = std::min({count, cores, most_threads});
    std::vector<std::jthread> others;
    for (int k = 1; k < threads; ++k) {
        others.emplace_back(work);
    }
    work();
}

} // namespace vkfv::topography
