// Tracers on a device: exposures run one after another, the next one under way while the host takes the last.
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

// An exposure under way. Its calls have this order: set_out(), submit() until it is counted, hand_over(), finish().
class DeviceExposure {
  public:
    virtual ~DeviceExposure() = default;

    // Begins with the numbers counted before, or with zeros if there are none.
    virtual void set_out(std::span<const std::uint64_t> numbers) = 0;
    virtual std::size_t number_count() const = 0;
    // Submits as many of the units first ... end - 1, in their order, as the device may be given at a time; returns the
    // end of the submitted ones.
    virtual std::uint64_t submit(std::uint64_t first, std::uint64_t end) = 0;
    // All numbers counted so far; waits for the device.
    virtual std::vector<std::uint64_t> numbers() = 0;
    // Submits the commands that bring the result to the host.
    virtual void hand_over() = 0;
    // Waits for the device and makes the image; called once.
    virtual Image finish() = 0;
    // The works by which it submits, in the order of its submissions.
    virtual std::vector<ExposureWork*> works() = 0;
};

// An exposure whose work is a single sequence of submissions.
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

    // The following functions serve begin(), count(), and mixtures, which make one exposure of those of several
    // tracers.

    // Number of exposures that may be under way, at most most_exposures; a caller that begins another waits.
    virtual std::size_t slots() const = 0;
    // An exposure that has nothing to do yet. Not called by two threads at a time, and no other exposure is begun
    // before this one has been handed over: all share the device's memory except their slots' own.
    virtual std::unique_ptr<DeviceExposure> prepare(FocalPosition position, std::uint32_t image,
                                                    std::size_t slot) const = 0;

  private:
    struct UnderWay;

    std::size_t take_slot() const;
    void give_back(std::size_t slot) const;
    // Submits units of the exposure as ExposureWork; returns the end of the submitted ones.
    std::uint64_t submitted(DeviceExposure& exposure, std::uint64_t first, std::uint64_t end) const;
    void trace(DeviceExposure& exposure, std::uint32_t image, const Checkpoints* checkpoints) const;
    Image finished(UnderWay& exposure) const;

    mutable std::mutex starting_;
    mutable std::mutex mutex_; // guards the members that follow
    mutable std::condition_variable given_back_;
    mutable std::array<bool, most_exposures> taken_{};
    mutable std::optional<std::uint64_t> first_tick_; // device tick at which the first of all exposures began
};

} // namespace vkfv::trace
