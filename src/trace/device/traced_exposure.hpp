// The base class of the exposures of forward and backward tracers.
#pragma once

#include "trace/device/device_estimate.hpp"
#include "trace/device/device_exposures.hpp"
#include "trace/device/device_numbers.hpp"
#include "trace/device/device_scene.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace vkfv::trace {

class TracedExposure : public SingleExposure {
  public:
    // The parts that an exposure works with. All of them must outlive it.
    struct Of {
        const DeviceScene& scene;
        const ExposureMemory& memory;
        const DeviceEstimate& estimate;
        const DeviceNumbers& numbers;
        DispatchPace& pace;
        std::size_t slot;
    };
    explicit TracedExposure(const Of& its) : SingleExposure(*its.scene.device, its.pace), of(its) {}

    void set_out(std::span<const std::uint64_t> numbers) final {
        clears_ = numbers.empty();
        if (!clears_) {
            of.numbers.write(work, numbers);
        }
    }

    std::size_t number_count() const final { return of.numbers.count(); }
    std::vector<std::uint64_t> numbers() final { return of.numbers.read(work); }

    void hand_over() final {
        of.scene.make_wave_image(work);
        of.estimate.record(work.open(), of.slot);
        work.submit();
    }

  protected:
    // Opens the next submission; the first one begins with the order of paths, and with clearing the trace's counts
    // unless it goes on from other numbers.
    template <class Trace>
    vulkan::Commands& open(const Trace& trace) {
        of.scene.require_waves();
        vulkan::Commands& commands = work.open();
        if (std::exchange(begins_, false)) {
            of.scene.give_emission_order(commands, of.memory);
        }
        if (std::exchange(clears_, false)) {
            trace.clear(commands);
            of.scene.clear_sorted_light(commands);
        }
        return commands;
    }

    // Submits the opened submission. paths: number that it traces.
    void close(std::uint64_t paths) {
        work.submit(paths);
        of.estimate.make_room(of.slot);
    }

    const Of of;

  private:
    bool begins_ = true;
    bool clears_ = true;
};

} // namespace vkfv::trace
