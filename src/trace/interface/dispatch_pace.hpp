// How many paths a device is given at a time, by what it took for those before.
#pragma once

#include <cstdint>
#include <mutex>

namespace vkfv::trace {

// A submission is meant to take 100 ms at most, so that none takes longer than 200 ms: a display that shares the
// device, a driver's watchdog and whoever interrupts the run wait for its end. The first ones are short until the
// device's rate is known. May be called by several threads at a time.
class DispatchPace {
  public:
    // most: paths of a submission, however fast the device is.
    explicit DispatchPace(std::uint64_t most);

    // That the next submission may hold, at least 1.
    std::uint64_t paths() const;
    // The rate is known well enough that submissions need not be waited for one by one.
    bool settled() const;
    // seconds: by the device's clock.
    void took(std::uint64_t paths, double seconds);

  private:
    mutable std::mutex mutex_; // of what follows
    std::uint64_t most_;
    std::uint64_t paths_;
    bool settled_ = false;
};

} // namespace vkfv::trace
