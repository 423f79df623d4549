#include "trace/device/exposure_work.hpp"

#include <algorithm>

namespace vkfv::trace {

namespace {

// Most submissions under way: enough that a device is not left waiting, and few enough that an exposure of very many
// rays does not fill the host's memory with its submissions.
constexpr std::size_t most_under_way = 16;

} // namespace

vulkan::Commands& ExposureWork::open() {
    vulkan::Commands& commands = under_way_.emplace_back(*device_).commands;
    commands.timestamp();
    return commands;
}

void ExposureWork::submit(std::uint64_t paths) {
    Submission& last = under_way_.back();
    last.paths = paths;
    last.commands.barrier();
    last.commands.timestamp();
    last.commands.submit();
    if (paths > 0 && !pace_->settled()) {
        wait();
    } else if (under_way_.size() > most_under_way) {
        wait(done_);
    }
}

void ExposureWork::wait(std::size_t submission) {
    for (; done_ <= submission && !under_way_.empty(); ++done_) {
        vulkan::Commands& first = under_way_.front().commands;
        first.wait();
        const auto ticks = first.ticks();
        first_tick_ = first_tick_.value_or(ticks.front());
        last_tick_ = ticks.back();
        const double seconds = device_->seconds_between(ticks.front(), ticks.back());
        seconds_ += seconds;
        longest_ = std::max(longest_, seconds);
        if (const auto paths = under_way_.front().paths; paths > 0) {
            pace_->took(paths, seconds);
        }
        under_way_.pop_front();
    }
}

} // namespace vkfv::trace
