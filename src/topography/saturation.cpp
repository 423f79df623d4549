#include "topography/saturation.hpp"

#include <algorithm>

namespace vkfv::topography {
namespace {

constexpr float just_below = 0.98f; // as a share of the largest value

} // namespace

void SaturationCount::add(std::span<const float> values) {
    if (values.empty()) {
        return;
    }
    if (const float largest = *std::ranges::max_element(values); largest > largest_) {
        below_ = largest_ >= just_below * largest ? below_ + there_ : 0;
        there_ = 0;
        largest_ = largest;
    }
    const float least = just_below * largest_;
    const auto near = static_cast<std::size_t>(std::ranges::count_if(values, [&](float v) { return v >= least; }));
    const auto there = static_cast<std::size_t>(std::ranges::count(values, largest_));
    there_ += there;
    below_ += near - there;
    all_ += values.size();
}

Saturation SaturationCount::found() const {
    constexpr double least_share = 1e-4;
    constexpr std::size_t least_values = 1000; // fewer values may be equal by chance
    constexpr std::size_t times_as_many = 4;
    const double share = all_ > 0 ? static_cast<double>(there_) / static_cast<double>(all_) : 0;
    // Images that have one value everywhere are not photographs, and count as unsaturated.
    const bool saturated = largest_ > 0 && share >= least_share && all_ >= least_values &&
                           there_ > times_as_many * below_ && there_ < all_;
    return saturated ? Saturation{.level = largest_, .share = share} : Saturation{};
}

} // namespace vkfv::topography
