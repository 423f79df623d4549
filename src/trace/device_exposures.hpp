// Tracers on a device: exposures one after another, the next one under way while the host takes the last.
#pragma once

#include "trace/device_scene.hpp"
#include "trace/exposure_work.hpp"
#include "trace/tracer.hpp"

#include <array>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <future>
#include <memory>
#include <mutex>
#include <optional>

namespace vkfv::trace {

// One that is under way.
class DeviceExposure {
  public:
    explicit DeviceExposure(const vulkan::Device& device) : work(device) {}
    virtual ~DeviceExposure() = default;
    // Waits for the device and makes the image; once.
    virtual Image finish() = 0;

    ExposureWork work;
};

class DeviceExposures : public Tracer {
  public:
    Image expose(double focal_height, std::uint32_t image) const final { return begin(focal_height, image).get(); }
    std::future<Image> begin(double focal_height, std::uint32_t image) const final;
    int most_under_way() const final { return static_cast<int>(slots()); }

  protected:
    // How many may be under way, at most most_exposures; who begins another waits.
    virtual std::size_t slots() const = 0;
    // Hands its work over to the device, with what belongs to the slot alone. Not called by two threads at a time.
    virtual std::unique_ptr<DeviceExposure> start(double focal_height, std::uint32_t image, std::size_t slot) const = 0;

  private:
    struct UnderWay;

    std::size_t take_slot() const;
    void give_back(std::size_t slot) const;
    Image finished(UnderWay& exposure) const;

    mutable std::mutex starting_;
    mutable std::mutex mutex_; // of what follows
    mutable std::condition_variable given_back_;
    mutable std::array<bool, most_exposures> taken_{};
    mutable std::optional<std::uint64_t> first_tick_; // of all exposures
};

} // namespace vkfv::trace
