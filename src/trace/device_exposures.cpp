#include "trace/device_exposures.hpp"

#include <algorithm>
#include <chrono>

namespace vkfv::trace {

struct DeviceExposures::UnderWay {
    UnderWay(const DeviceExposures& of, std::size_t its_slot) : tracer(of), slot(its_slot) {}
    UnderWay(const UnderWay&) = delete;
    UnderWay& operator=(const UnderWay&) = delete;
    ~UnderWay() {
        exposure.reset(); // which waits for the device
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

std::future<Image> DeviceExposures::begin(double focal_height, std::uint32_t image) const {
    auto under_way = std::make_unique<UnderWay>(*this, take_slot());
    {
        const std::scoped_lock lock(starting_);
        under_way->exposure = start(focal_height, image, under_way->slot);
    }
    return std::async(std::launch::deferred, [this, exposure = std::move(under_way)] { return finished(*exposure); });
}

Image DeviceExposures::finished(UnderWay& under_way) const {
    Image image = under_way.exposure->finish();
    const ExposureWork& work = under_way.exposure->work;
    {
        const std::scoped_lock lock(mutex_);
        first_tick_ = first_tick_.value_or(work.first_tick());
        image.device_begin = device()->seconds_between(*first_tick_, work.first_tick());
        image.device_end = device()->seconds_between(*first_tick_, work.last_tick());
    }
    image.device_seconds = work.seconds();
    image.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - under_way.begun).count();
    return image;
}

} // namespace vkfv::trace
