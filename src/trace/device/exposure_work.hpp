// A device's work on one exposure: several submissions, of which a few are under way at a time.
#pragma once

#include "trace/interface/dispatch_pace.hpp"
#include "vulkan/kernel.hpp"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

namespace vkfv::trace {

class ExposureWork {
  public:
    // Device and pace must outlive it.
    ExposureWork(const vulkan::Device& device, DispatchPace& pace) : device_(&device), pace_(&pace) {}

    // Opens the next submission, with a timestamp in front.
    vulkan::Commands& open();
    // Ends the opened submission with a timestamp and submits it. paths: number that it traces, for the pace; 0: it has
    // other work. Waits for it where the pace is not known yet, and for earlier ones where many are under way.
    void submit(std::uint64_t paths = 0);
    std::size_t submissions() const { return done_ + under_way_.size(); }
    // Waits until the submission of this number, and all before it, have been done.
    void wait(std::size_t submission);
    void wait() { wait(submissions() - 1); }

    // Times of the work that has been waited for: device ticks of the first beginning and the last end.
    std::uint64_t first_tick() const { return first_tick_.value(); }
    std::uint64_t last_tick() const { return last_tick_; }
    double seconds() const { return seconds_; } // sum over submissions, each from its beginning to its end
    double longest() const { return longest_; } // s, of the longest submission

  private:
    struct Submission {
        explicit Submission(const vulkan::Device& device) : commands(device, 2) {}
        vulkan::Commands commands;
        std::uint64_t paths = 0;
    };

    const vulkan::Device* device_;
    DispatchPace* pace_;
    std::deque<Submission> under_way_;
    std::size_t done_ = 0;
    std::optional<std::uint64_t> first_tick_;
    std::uint64_t last_tick_ = 0;
    double seconds_ = 0;
    double longest_ = 0;
};

} // namespace vkfv::trace
