// Conversion between metres, common in files, and mm, used internally. A length that was converted for writing is
// restored to the same bits.
#pragma once

#include <cmath>
#include <initializer_list>
#include <limits>

namespace vkfv::surface {

inline constexpr double mm_per_metre = 1e3;

// Metres from mm, without -0, into which some sums turn 0.
inline double metres_from_mm(double mm) {
    return mm / mm_per_metre + 0.0;
}

// Mm from metres, the inverse of metres_from_mm(). The quotient is off by half a step of its own and the product by
// another half, together less than two steps of the product, so the original mm is the product or one of its
// neighbours.
inline double mm_from_metres(double metres) {
    const double mm = metres * mm_per_metre;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (const double candidate : {mm, std::nextafter(mm, -infinity), std::nextafter(mm, infinity)})
        if (metres_from_mm(candidate) == metres)
            return candidate;
    return mm;
}

// Mm from metres; NaN, which means not measured, for all values that are not finite.
inline double height_from_metres(double metres) {
    const double mm = mm_from_metres(metres);
    return std::isfinite(mm) ? mm : std::numeric_limits<double>::quiet_NaN();
}

} // namespace vkfv::surface
