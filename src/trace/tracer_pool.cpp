#include "trace/tracer_pool.hpp"

#include "vulkan/failure.hpp"

#include <fmt/format.h>

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

namespace vkfv::trace {

void rethrow_as_failure_of(int place) {
    try {
        throw;
    } catch (vulkan::DeviceFailure& failure) {
        failure.place = place;
        throw;
    } catch (const vk::SystemError& error) {
        auto failure = vulkan::run_error_of(error);
        failure.place = place;
        throw failure;
    }
}

namespace {

class TracerPool final : public Tracer {
  public:
    explicit TracerPool(std::vector<std::unique_ptr<Tracer>> tracers) : tracers_(std::move(tracers)) {
        for (std::size_t place = 0; place < tracers_.size(); ++place) {
            threads_.emplace_back([this, place] { work(place); });
        }
    }
    ~TracerPool() override {
        {
            const std::scoped_lock lock(mutex_);
            ends_ = true;
        }
        changed_.notify_all();
    }

    Image expose(double focal_height, std::uint32_t image) const override { return begin(focal_height, image).get(); }

    std::future<Image> begin(double focal_height, std::uint32_t image) const override {
        Job job{focal_height, image, {}};
        auto future = job.done.get_future();
        {
            const std::scoped_lock lock(mutex_);
            waiting_.push_back(std::move(job));
        }
        changed_.notify_all();
        return future;
    }

    // One more each than they work on: a device that is ahead need not wait for the image that is taken next.
    int most_under_way() const override {
        int most = 0;
        for (const auto& tracer : tracers_) {
            most += tracer->most_under_way() + 1;
        }
        return most;
    }

    std::string description() const override {
        return fmt::format("{} devices at a time: {}", tracers_.size(), tracers_.front()->description());
    }
    TracerIdentity identity() const override { return tracers_.front()->identity(); }
    std::shared_ptr<const vulkan::Device> device() const override { return tracers_.front()->device(); }
    const optics::PupilFilter* pupil_filter() const override { return tracers_.front()->pupil_filter(); }

  private:
    struct Job {
        double focal_height;
        std::uint32_t image;
        std::promise<Image> done;
    };
    struct Begun {
        std::promise<Image> done;
        std::future<Image> image;
    };

    // None: the pool ends, or the device has begun others and may finish them meanwhile.
    std::optional<Job> next(bool wait) const {
        std::unique_lock lock(mutex_);
        if (wait) {
            changed_.wait(lock, [&] { return ends_ || !waiting_.empty(); });
        }
        if (ends_ || waiting_.empty()) {
            return std::nullopt;
        }
        Job job = std::move(waiting_.front());
        waiting_.pop_front();
        return job;
    }

    bool ends() const {
        const std::scoped_lock lock(mutex_);
        return ends_;
    }

    // A device's thread.
    void work(std::size_t place) const {
        const Tracer& tracer = *tracers_[place];
        const auto fail = [&](std::promise<Image>& done) {
            try {
                rethrow_as_failure_of(static_cast<int>(place));
            } catch (...) {
                done.set_exception(std::current_exception());
            }
        };
        std::deque<Begun> begun;
        while (!ends()) {
            while (static_cast<int>(begun.size()) < tracer.most_under_way()) {
                auto job = next(begun.empty());
                if (!job) {
                    break;
                }
                try {
                    auto image = tracer.begin(job->focal_height, job->image);
                    begun.push_back({std::move(job->done), std::move(image)});
                } catch (...) {
                    fail(job->done);
                }
            }
            if (begun.empty()) {
                continue;
            }
            Begun first = std::move(begun.front());
            begun.pop_front();
            try {
                Image image = first.image.get();
                image.device = static_cast<int>(place);
                first.done.set_value(std::move(image));
            } catch (...) {
                fail(first.done);
            }
        }
    }

    std::vector<std::unique_ptr<Tracer>> tracers_;
    mutable std::mutex mutex_; // of what follows
    mutable std::condition_variable changed_;
    mutable std::deque<Job> waiting_;
    bool ends_ = false;
    std::vector<std::jthread> threads_;
};

} // namespace

std::unique_ptr<Tracer> make_tracer_pool(std::vector<std::unique_ptr<Tracer>> tracers) {
    return std::make_unique<TracerPool>(std::move(tracers));
}

} // namespace vkfv::trace
