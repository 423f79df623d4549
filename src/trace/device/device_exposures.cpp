#include "trace/device/device_exposures.hpp"

#include "core/messages/heartbeat.hpp"

#include <algorithm>
#include <chrono>

namespace vkfv::trace {

struct DeviceExposures::UnderWay {
    UnderWay(const DeviceExposures& of, std::size_t its_slot) : tracer(of), slot(its_slot) {}
    UnderWay(const UnderWay&) = delete;
    UnderWay& operator=(const UnderWay&) = delete;
    ~UnderWay() {
        exposure.reset(); // its destructor waits for the device
        tracer.give_back(slot);
    }

    const DeviceExposures& tracer;
    std::size_t slot;
    std::chrono::steady_clock::time_point begun = std::chrono::steady_clock::now();
    std::unique_ptr<DeviceExposure> exposure;
};

std::size_t DeviceExposures::take_slot() const {
    std::unique_lock lock(mutex_);
    std::size_t slot = 0;
    given_back_.wait(lock, [&] {
        slot = static_cast<std::size_t>(std::find(taken_.begin(), taken_.end(), false) - taken_.begin());
        return slot < slots();
    });
    taken_[slot] = true;
    return slot;
}

void DeviceExposures::give_back(std::size_t slot) const {
    {
        const std::scoped_lock lock(mutex_);
        taken_[slot] = false;
    }
    given_back_.notify_one();
}

std::uint64_t DeviceExposures::submitted(DeviceExposure& exposure, std::uint64_t first, std::uint64_t end) const {
    const std::uint64_t done = exposure.submit(first, end);
    advance_work(static_cast<double>(done - first) / static_cast<double>(units()));
    return done;
}

void DeviceExposures::trace(DeviceExposure& exposure, std::uint32_t image, const Checkpoints* checkpoints) const {
    std::uint64_t done = 0;
    auto found = checkpoints != nullptr ? checkpoints->load(image) : std::nullopt;
    if (found && found->done <= units() && found->numbers.size() == exposure.number_count()) {
        done = found->done;
        exposure.set_out(found->numbers);
    } else {
        exposure.set_out({});
    }
    found.reset();
    CheckpointClock clock(checkpoints);
    while (done < units()) {
        done = submitted(exposure, done, units());
        if (done < units() && clock.due()) {
            const auto begun = CheckpointClock::Clock::now();
            checkpoints->save(image, {done, exposure.numbers()});
            clock.kept(begun);
        }
    }
    exposure.hand_over();
}

std::future<Image> DeviceExposures::begin(FocalPosition position, std::uint32_t image,
                                          std::shared_ptr<const Checkpoints> checkpoints) const {
    auto under_way = std::make_unique<UnderWay>(*this, take_slot());
    {
        const std::scoped_lock lock(starting_);
        under_way->exposure = prepare(position, image, under_way->slot);
        trace(*under_way->exposure, image, checkpoints.get());
    }
    return std::async(std::launch::deferred, [this, exposure = std::move(under_way)] { return finished(*exposure); });
}

ExposurePart DeviceExposures::count(FocalPosition position, std::uint32_t image, std::uint64_t first,
                                    std::uint64_t end) const {
    UnderWay under_way(*this, take_slot());
    const std::scoped_lock lock(starting_);
    under_way.exposure = prepare(position, image, under_way.slot);
    DeviceExposure& exposure = *under_way.exposure;
    exposure.set_out({});
    while (first < end) {
        first = submitted(exposure, first, end);
    }
    ExposurePart part{.numbers = exposure.numbers()};
    for (const ExposureWork* work : exposure.works()) {
        part.device_seconds += work->seconds();
        part.longest_submission = std::max(part.longest_submission, work->longest());
    }
    return part;
}

Image DeviceExposures::finished(UnderWay& under_way) const {
    Image image = under_way.exposure->finish();
    const auto works = under_way.exposure->works();
    image.device_seconds = image.longest_submission = 0;
    for (ExposureWork* work : works) {
        work->wait();
        image.device_seconds += work->seconds();
        image.longest_submission = std::max(image.longest_submission, work->longest());
    }
    {
        const std::scoped_lock lock(mutex_);
        first_tick_ = first_tick_.value_or(works.front()->first_tick());
        image.device_begin = device()->seconds_between(*first_tick_, works.front()->first_tick());
        image.device_end = device()->seconds_between(*first_tick_, works.back()->last_tick());
    }
    image.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - under_way.begun).count();
    return image;
}

} // namespace vkfv::trace
