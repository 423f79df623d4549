#include "trace/interface/tracer_pool.hpp"

#include "vulkan/failure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <iterator>
#include <limits>
#include <mutex>
#include <optional>
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

// The sum of an exposure's parts, in the form of a checkpoint from which the image is made.
class Counted final : public Checkpoints {
  public:
    explicit Counted(Checkpoint checkpoint) : checkpoint_(std::move(checkpoint)) {}
    double interval() const override { return std::numeric_limits<double>::infinity(); }
    std::optional<Checkpoint> load(std::uint32_t /*image*/) const override { return checkpoint_; }
    void save(std::uint32_t /*image*/, const Checkpoint& /*checkpoint*/) const override {}

  private:
    Checkpoint checkpoint_;
};

// An exposure whose parts several devices count.
struct Parted {
    std::promise<Image> done;
    std::chrono::steady_clock::time_point begun = std::chrono::steady_clock::now();
    std::mutex mutex; // guards the members that follow
    ExposurePart sum;
    std::size_t missing = 0; // number of parts not yet counted
    bool failed = false;
};

class TracerPool final : public Tracer {
  public:
    TracerPool(std::vector<std::unique_ptr<Tracer>> tracers, std::uint64_t least_parted)
        : tracers_(std::move(tracers)), least_parted_(least_parted) {
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

    Image expose(FocalPosition position, std::uint32_t image) const override { return begin(position, image).get(); }

    std::future<Image> begin(FocalPosition position, std::uint32_t image,
                             std::shared_ptr<const Checkpoints> checkpoints = nullptr) const override {
        std::vector<Job> jobs;
        std::future<Image> future;
        if (const Tracer& any = *tracers_.front();
            any.units() > 0 && any.units() * any.rays_per_unit() >= least_parted_) {
            const std::uint64_t units = any.units();
            auto parted = std::make_shared<Parted>();
            future = parted->done.get_future();
            const std::uint64_t parts = std::min<std::uint64_t>(units, tracers_.size());
            parted->missing = parts;
            for (std::uint64_t part = 0; part < parts; ++part) {
                jobs.push_back({.position = position,
                                .image = image,
                                .parted = parted,
                                .first = units / parts * part + std::min(part, units % parts),
                                .end = units / parts * (part + 1) + std::min(part + 1, units % parts)});
            }
        } else {
            jobs.push_back({.position = position, .image = image, .checkpoints = std::move(checkpoints)});
            future = jobs.back().done.get_future();
        }
        {
            const std::scoped_lock lock(mutex_);
            std::ranges::move(jobs, std::back_inserter(waiting_));
        }
        changed_.notify_all();
        return future;
    }

    // A device may have one exposure more than it works on, so that it need not wait for the image that is taken next.
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
    std::vector<optics::PupilFilter> pupil_filters() const override { return tracers_.front()->pupil_filters(); }

  private:
    // An exposure, or one of its parts.
    struct Job {
        FocalPosition position;
        std::uint32_t image = 0;
        std::shared_ptr<const Checkpoints> checkpoints{};
        std::promise<Image> done{};
        std::shared_ptr<Parted> parted{};
        std::uint64_t first = 0;
        std::uint64_t end = 0;
    };
    struct Begun {
        std::promise<Image> done;
        std::future<Image> image;
        ExposurePart parts{};                                          // sum of the parts that it is made of
        std::optional<std::chrono::steady_clock::time_point> parted{}; // when its parts were begun
    };

    // The next job; none if the pool ends, or if not waiting and there is none (the device may finish begun images
    // meanwhile).
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

    // Counts a part; the caller that counts the last part begins the image.
    static std::optional<Begun> count(const Tracer& tracer, const Job& job) {
        Parted& parted = *job.parted;
        {
            const std::scoped_lock lock(parted.mutex);
            if (parted.failed) {
                return std::nullopt;
            }
        }
        auto part = tracer.count(job.position, job.image, job.first, job.end);
        const std::scoped_lock lock(parted.mutex);
        ExposurePart& sum = parted.sum;
        if (sum.numbers.empty()) {
            sum.numbers = std::move(part.numbers);
        } else {
            std::ranges::transform(sum.numbers, part.numbers, sum.numbers.begin(), std::plus<>());
        }
        sum.device_seconds += part.device_seconds;
        sum.longest_submission = std::max(sum.longest_submission, part.longest_submission);
        if (parted.failed || --parted.missing > 0) {
            return std::nullopt;
        }
        auto counted = std::make_shared<const Counted>(Checkpoint{tracer.units(), std::move(sum.numbers)});
        auto image = tracer.begin(job.position, job.image, std::move(counted));
        return Begun{
            .done = std::move(parted.done), .image = std::move(image), .parts = std::move(sum), .parted = parted.begun};
    }

    // The loop of a device's thread.
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
                    if (!job->parted) {
                        auto image = tracer.begin(job->position, job->image, std::move(job->checkpoints));
                        begun.push_back({.done = std::move(job->done), .image = std::move(image)});
                    } else if (auto last = count(tracer, *job)) {
                        begun.push_back(std::move(*last));
                    }
                } catch (...) {
                    if (!job->parted) {
                        fail(job->done);
                    } else if (const std::scoped_lock lock(job->parted->mutex);
                               !std::exchange(job->parted->failed, true)) {
                        fail(job->parted->done);
                    }
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
                image.device_seconds += first.parts.device_seconds / static_cast<double>(tracers_.size());
                image.longest_submission = std::max(image.longest_submission, first.parts.longest_submission);
                if (first.parted) {
                    image.seconds =
                        std::chrono::duration<double>(std::chrono::steady_clock::now() - *first.parted).count();
                }
                first.done.set_value(std::move(image));
            } catch (...) {
                fail(first.done);
            }
        }
    }

    std::vector<std::unique_ptr<Tracer>> tracers_;
    std::uint64_t least_parted_;
    mutable std::mutex mutex_; // guards the members that follow
    mutable std::condition_variable changed_;
    mutable std::deque<Job> waiting_;
    bool ends_ = false;
    std::vector<std::jthread> threads_;
};

} // namespace

std::unique_ptr<Tracer> make_tracer_pool(std::vector<std::unique_ptr<Tracer>> tracers, std::uint64_t least_parted) {
    return std::make_unique<TracerPool>(std::move(tracers), least_parted);
}

} // namespace vkfv::trace
