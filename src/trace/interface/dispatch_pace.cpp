#include "trace/interface/dispatch_pace.hpp"

#include <algorithm>

namespace vkfv::trace {

namespace {

constexpr double aim = 0.1;                       // s
constexpr std::uint64_t first_paths = 1ull << 14; // some milliseconds on one core
constexpr std::uint64_t most_growth = 8;          // few paths do not fill a GPU, so their rate is not that of many

} // namespace

DispatchPace::DispatchPace(std::uint64_t most)
    : most_(std::max<std::uint64_t>(1, most)), paths_(std::min(most_, first_paths)) {}

std::uint64_t DispatchPace::paths() const {
    const std::scoped_lock lock(mutex_);
    return paths_;
}

bool DispatchPace::settled() const {
    const std::scoped_lock lock(mutex_);
    return settled_;
}

void DispatchPace::took(std::uint64_t paths, double seconds) {
    const std::scoped_lock lock(mutex_);
    if (2 * paths < paths_ && seconds < aim) {
        return; // the rest of an exposure is too short to show a rate
    }
    const double fitting = static_cast<double>(paths) * aim / std::max(seconds, 1e-9);
    const std::uint64_t grown = std::min(most_, most_growth * paths_);
    settled_ = settled_ || fitting < static_cast<double>(grown) || grown == most_;
    paths_ =
        fitting < static_cast<double>(grown) ? std::max<std::uint64_t>(1, static_cast<std::uint64_t>(fitting)) : grown;
}

} // namespace vkfv::trace
