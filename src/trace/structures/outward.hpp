// Rounds bounds from double to float so that they enclose the double's.
#pragma once

#include <cmath>
#include <limits>

namespace vkfv::trace {

inline float next_below(float value) {
    return std::nextafter(value, -std::numeric_limits<float>::infinity());
}
inline float next_above(float value) {
    return std::nextafter(value, std::numeric_limits<float>::infinity());
}

} // namespace vkfv::trace
