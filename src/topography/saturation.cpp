#include "topography/saturation.hpp"

#include <algorithm>

namespace vkfv::topography {

void SaturationCount::add(std::span<const float> values) {
    for (const float value : values) {
        if (value >= levels_.back().value) {
            count(value);
        }
    }
    all_ += values.size();
}

// A level that is among the largest at last was among them whenever it occurred, so its count is complete.
void SaturationCount::count(float value) {
    auto* const level = std::ranges::find_if(levels_, [&](const Level& l) { return l.value <= value; });
    if (level->value < value) {
        std::shift_right(level, levels_.end(), 1);
        *level = {.value = value};
    }
    ++level->values;
}

Saturation SaturationCount::found() const {
    constexpr double least_share = 1e-4;
    constexpr std::size_t least_values = 1000, least_saturated = 10; // fewer values may be equal by chance
    // Stretched grey values fill some levels twice, and bright textures have turning points. Both raise a level's count
    // less than this. A file's largest integer, 1, needs less evidence: it is where values end for certain, and where
    // contrast is low the levels further down are frequent too.
    constexpr std::size_t times_as_many = 4, times_as_many_at_the_end = 2;
    const Level& largest = levels_.front();
    const bool at_the_end = largest.value == 1;
    const std::size_t below =
        at_the_end ? levels_[1].values
                   : std::ranges::max_element(levels_.begin() + 1, levels_.end(), {}, &Level::values)->values;
    const double share = all_ > 0 ? static_cast<double>(largest.values) / static_cast<double>(all_) : 0;
    const std::size_t times = at_the_end ? times_as_many_at_the_end : times_as_many;
    // Images that have one value everywhere are not photographs, and count as unsaturated.
    const bool saturated = largest.value > 0 && share >= least_share && all_ >= least_values &&
                           largest.values >= least_saturated && largest.values > times * below && below > 0;
    return saturated ? Saturation{.level = largest.value, .share = share} : Saturation{};
}

} // namespace vkfv::topography
