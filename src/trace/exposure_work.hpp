// A device's work on one exposure: several submissions, none of them waited for before what it has done is wanted.
#pragma once

#include "vulkan/kernel.hpp"

#include <cstddef>
#include <cstdint>
#include <deque>

namespace vkfv::trace {

class ExposureWork {
  public:
    // The device must outlive it.
    explicit ExposureWork(const vulkan::Device& device) : device_(&device) {}

    // Opens the next submission, with a timestamp in front.
    vulkan::Commands& open();
    // Stamps and submits it.
    void submit();
    std::size_t submissions() const { return submissions_.size(); }
    // Until the submission of this number, and those before, have been done.
    void wait(std::size_t submission);

    // The rest is told when all have been done. Device ticks of the first beginning and the last end.
    std::uint64_t first_tick() const { return submissions_.front().ticks().front(); }
    std::uint64_t last_tick() const { return submissions_.back().ticks().back(); }
    double seconds() const; // from each one's beginning to its end

  private:
    const vulkan::Device* device_;
    std::deque<vulkan::Commands> submissions_;
};

} // namespace vkfv::trace
