// Threads that share a piece of work.
#pragma once

#include <algorithm>
#include <thread>
#include <vector>

namespace vkfv {

// The number of threads that the machine runs at once, at least 1.
inline int core_count() {
    return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

// Calls work(k) for k = 0 ... threads - 1, each on a thread of its own, k = 0 on the caller's; returns when all have
// returned. `work` must not throw. Threads are started for each call, because those started by a task of
// in_background() inherit its low priority, which those of a pool such as that of std::execution's TBB would not.
template <class Work>
void on_threads(int threads, const Work& work) {
    std::vector<std::jthread> others;
    for (int k = 1; k < threads; ++k) {
        others.emplace_back([&work, k] { work(k); });
    }
    work(0);
}

} // namespace vkfv
