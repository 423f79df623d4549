// Lengths in files are often metres, inside they are mm; what a writer divided comes back to the same bits.
#pragma once

#include <cmath>
#include <initializer_list>
#include <limits>

namespace vkfv::surface {

inline constexpr double mm_per_metre = 1e3;

// Never -0, which some sums turn into 0.
inline double metres_from_mm(double mm) {
    return mm / mm_per_metre + 0.0;
}

// The quotient is off by half a step of its own and the product by another half, together less than two steps of the
// product: the mm that gave these metres are the product or one of its neighbours.
inline double mm_from_metres(double metres) {
    const double mm = metres * mm_per_metre;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (const double candidate : {mm, std::nextafter(mm, -infinity), std::nextafter(mm, infinity)})
        if (metres_from_mm(candidate) == metres)
            return candidate;
    return mm;
}

// NaN, which means not measured, for whatever is not finite.
inline double height_from_metres(double metres) {
    const double mm = mm_from_metres(metres);
    return std::isfinite(mm) ? mm : std::numeric_limits<double>::quiet_NaN();
}

} // namespace vkfv::surface
