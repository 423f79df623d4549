// Checkpoints: a long exposure continues where another run was ended.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

namespace vkfv::trace {

// The counts of an exposure so far. Units and numbers are the tracer's own: only a tracer of the same identity, with
// the same number of rays, seed, image and focal height, continues from them.
struct Checkpoint {
    std::uint64_t done = 0; // number of the tracer's units of work done, from the first on
    std::vector<std::uint64_t> numbers;
};

// Storage of checkpoints. Several exposures of different images may call it at a time.
class Checkpoints {
  public:
    virtual ~Checkpoints() = default;
    virtual double interval() const = 0; // s, between two checkpoints of an exposure
    virtual std::optional<Checkpoint> load(std::uint32_t image) const = 0;
    // Saves a checkpoint. A failure is only logged: the exposure goes on.
    virtual void save(std::uint32_t image, const Checkpoint& checkpoint) const = 0;
};

// Says when an exposure's next checkpoint is due. Saving takes a twentieth of the time at most.
class CheckpointClock {
  public:
    using Clock = std::chrono::steady_clock;

    // checkpoints: null: none is ever due.
    explicit CheckpointClock(const Checkpoints* checkpoints)
        : interval_(checkpoints != nullptr ? std::optional(std::chrono::duration<double>(checkpoints->interval()))
                                           : std::nullopt) {}

    bool due() const { return interval_ && Clock::now() - last_ >= *interval_; }
    // Records that a checkpoint was saved. begun: time at which saving began.
    void kept(Clock::time_point begun) {
        last_ = Clock::now();
        interval_ = std::max<std::chrono::duration<double>>(*interval_, 20 * (last_ - begun));
    }

  private:
    std::optional<std::chrono::duration<double>> interval_;
    Clock::time_point last_ = Clock::now();
};

} // namespace vkfv::trace
