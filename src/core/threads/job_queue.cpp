#include "core/threads/job_queue.hpp"

#include <utility>

namespace vkfv {

JobQueue::JobQueue(int threads, std::size_t most_waiting) : most_waiting_(most_waiting) {
    for (int k = 0; k < threads; ++k) {
        threads_.emplace_back([this] { work(); });
    }
}

JobQueue::~JobQueue() {
    {
        const std::scoped_lock lock(mutex_);
        ends_ = true;
        waiting_.clear();
    }
    changed_.notify_all();
    threads_.clear(); // joins the threads while the members that they use exist
}

void JobQueue::add(std::function<void()> job) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return thrown_ || waiting_.size() < most_waiting_; });
    rethrow();
    waiting_.push_back(std::move(job));
    changed_.notify_all();
}

void JobQueue::finish() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return busy_ == 0 && (thrown_ || waiting_.empty()); });
    rethrow();
}

void JobQueue::rethrow() {
    if (thrown_) {
        waiting_.clear();
        std::rethrow_exception(thrown_);
    }
}

void JobQueue::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return ends_ || (!waiting_.empty() && !thrown_); });
        if (ends_) {
            return;
        }
        {
            const auto job = std::move(waiting_.front());
            waiting_.pop_front();
            ++busy_;
            changed_.notify_all();
            lock.unlock();
            std::exception_ptr thrown;
            try {
                job();
            } catch (...) {
                thrown = std::current_exception();
            }
            lock.lock();
            thrown_ = thrown_ ? thrown_ : thrown;
        } // the job's own data are released here
        --busy_;
        changed_.notify_all();
    }
}

} // namespace vkfv
