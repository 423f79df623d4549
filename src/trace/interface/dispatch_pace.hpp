// The number of paths that a device is given at a time, from the times of earlier submissions.
#pragma once

#include <cstdint>
#include <mutex>

namespace vkfv::trace {

// A submission is meant to take at most 100 ms, so that none takes longer than 200 ms: a display that shares the
// device, a driver's watchdog and a user's interrupt wait for its end. The first submissions are short until the
// device's rate is known. May be called by several threads at a time.
class DispatchPace {
  public:
    // most: largest number of paths of a submission, however fast the device is.
    explicit DispatchPace(std::uint64_t most);

    // The number of paths for the next submission, at least 1.
    std::uint64_t paths() const;
    // True if the rate is known well enough that submissions need not be waited for one by one.
    bool settled() const;
    // Records the time of a submission. seconds: by the device's clock.
    void took(std::uint64_t paths, double seconds);

  private:
    mutable std::mutex mutex_; // guards the members that follow
    std::uint64_t most_;
    std::uint64_t paths_;
    bool settled_ = false;
};

} // namespace vkfv::trace
