// A long exposure that goes on where another run was ended.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

namespace vkfv::trace {

// What an exposure has counted so far. Units and numbers are the tracer's own: only one of the same identity, with the
// same number of rays, seed, image and focal height, takes it up.
struct Checkpoint {
    std::uint64_t done = 0; // of the tracer's units of work, the first ones
    std::vector<std::uint64_t> numbers;
};

// Where they are kept. Several exposures of different images may ask at a time.
class Checkpoints {
  public:
    virtual ~Checkpoints() = default;
    virtual double interval() const = 0; // s, between two of an exposure
    virtual std::optional<Checkpoint> load(std::uint32_t image) const = 0;
    // What cannot be kept is told to the log: the exposure goes on.
    virtual void save(std::uint32_t image, const Checkpoint& checkpoint) const = 0;
};

// When an exposure's next checkpoint is due. Keeping them takes a twentieth of the time at most.
class CheckpointClock {
  public:
    using Clock = std::chrono::steady_clock;

    // none: never.
    explicit CheckpointClock(const Checkpoints* checkpoints)
        : interval_(checkpoints != nullptr ? std::optional(std::chrono::duration<double>(checkpoints->interval()))
                                           : std::nullopt) {}

    bool due() const { return interval_ && Clock::now() - last_ >= *interval_; }
    // begun: when it became due.
    void kept(Clock::time_point begun) {
        last_ = Clock::now();
        interval_ = std::max<std::chrono::duration<double>>(*interval_, 20 * (last_ - begun));
    }

  private:
    std::optional<std::chrono::duration<double>> interval_;
    Clock::time_point last_ = Clock::now();
};

} // namespace vkfv::trace
