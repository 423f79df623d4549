// Jobs that threads of their own do, while who gives them goes on.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace vkfv {

// Begun in the order given; one after the other if there is one thread. After one has thrown, those that wait are
// dropped. add() and finish() are one thread's.
class JobQueue {
  public:
    // most_waiting: jobs that no thread has begun, at least 1; add() waits for room.
    JobQueue(int threads, std::size_t most_waiting);
    // Drops those that wait, lets the others end.
    ~JobQueue();
    JobQueue(const JobQueue&) = delete;
    JobQueue& operator=(const JobQueue&) = delete;

    // Both throw what a job has thrown.
    void add(std::function<void()> job);
    void finish(); // waits for all

  private:
    void work();
    void rethrow(); // with the lock held

    std::size_t most_waiting_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::function<void()>> waiting_;
    int busy_ = 0;
    bool ends_ = false;
    std::exception_ptr thrown_;
    std::vector<std::jthread> threads_;
};

} // namespace vkfv
