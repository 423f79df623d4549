#include "trace/exposure_work.hpp"

namespace vkfv::trace {

vulkan::Commands& ExposureWork::open() {
    vulkan::Commands& commands = submissions_.emplace_back(*device_, 2);
    commands.timestamp();
    return commands;
}

void ExposureWork::submit() {
    submissions_.back().barrier();
    submissions_.back().timestamp();
    submissions_.back().submit();
}

void ExposureWork::wait(std::size_t submission) {
    submissions_[submission].wait();
}

double ExposureWork::seconds() const {
    double seconds = 0;
    for (const vulkan::Commands& commands : submissions_) {
        seconds += commands.seconds().back();
    }
    return seconds;
}

} // namespace vkfv::trace
