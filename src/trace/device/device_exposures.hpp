// Tracers on a device: exposures one after another, the next one under way while the host takes the last.
#pragma once

#include "trace/device/device_scene.hpp"
#include "trace/device/exposure_work.hpp"
#include "trace/interface/tracer.hpp"

#include <array>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

namespace vkfv::trace {

// One that is under way, in this order: set_out(), submit() until it is counted, hand_over(), finish().
class DeviceExposure {
  public:
    virtual ~DeviceExposure() = default;

    // From the numbers that were counted before; none: from nothing.
    virtual void set_out(std::span<const std::uint64_t> numbers) = 0;
    virtual std::size_t number_count() const = 0;
    // Submits as much of the units first ... end - 1 as the device may be given at a time, in their order, and says
    // where that ends.
    virtual std::uint64_t submit(std::uint64_t first, std::uint64_t end) = 0;
    // All that was counted. Waits for it.
    virtual std::vector<std::uint64_t> numbers() = 0;
    // Submits what brings it to the host.
    virtual void hand_over() = 0;
    // Waits for the device and makes the image; once.
    virtual Image finish() = 0;
    // What it submits by, in the order of its submissions.
    virtual std::vector<ExposureWork*> works() = 0;
};

// One whose work is a single sequence.
class SingleExposure : public DeviceExposure {
  public:
    SingleExposure(const vulkan::Device& device, DispatchPace& pace) : work(device, pace) {}
    std::vector<ExposureWork*> works() final { return {&work}; }

  protected:
    ExposureWork work;
};

class DeviceExposures : public Tracer {
  public:
    Image expose(FocalPosition position, std::uint32_t image) const final { return begin(position, image).get(); }
    std::future<Image> begin(FocalPosition position, std::uint32_t image,
                             std::shared_ptr<const Checkpoints> checkpoints = nullptr) const final;
    int most_under_way() const final { return static_cast<int>(slots()); }
    ExposurePart count(FocalPosition position, std::uint32_t image, std::uint64_t first, std::uint64_t end) const final;

    // For begin(), count(), and for who makes one exposure of those of several tracers.

    // How many may be under way, at most most_exposures; who begins another waits.
    virtual std::size_t slots() const = 0;
    // One that has nothing to do yet. Not called by two threads at a time, nor are others begun before this one has
    // been handed over: they share the device's memory but for what belongs to the slot.
    virtual std::unique_ptr<DeviceExposure> prepare(FocalPosition position, std::uint32_t image,
                                                    std::size_t slot) const = 0;

  private:
    struct UnderWay;

    std::size_t take_slot() const;
    void give_back(std::size_t slot) const;
    // What the exposure submits, counted as work.
    std::uint64_t submitted(DeviceExposure& exposure, std::uint64_t first, std::uint64_t end) const;
    void trace(DeviceExposure& exposure, std::uint32_t image, const Checkpoints* checkpoints) const;
    Image finished(UnderWay& exposure) const;

    mutable std::mutex starting_;
    mutable std::mutex mutex_; // of what follows
    mutable std::condition_variable given_back_;
    mutable std::array<bool, most_exposures> taken_{};
    mutable std::optional<std::uint64_t> first_tick_; // of all exposures
};

} // namespace vkfv::trace
