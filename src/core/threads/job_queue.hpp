// A queue of jobs that run on threads of their own.
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

// Starts jobs in the order in which they were added; a single thread runs them one after the other. After a job has
// thrown, waiting jobs are dropped. add() and finish() must be called by the same thread.
class JobQueue {
  public:
    // most_waiting: the largest number of jobs not yet started, at least 1; add() waits for room.
    JobQueue(int threads, std::size_t most_waiting);
    // Drops waiting jobs and waits for those that run.
    ~JobQueue();
    JobQueue(const JobQueue&) = delete;
    JobQueue& operator=(const JobQueue&) = delete;

    // add() and finish() rethrow the exception of a job.
    void add(std::function<void()> job);
    void finish(); // waits for all jobs

  private:
    void work();
    void rethrow(); // requires the lock

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
