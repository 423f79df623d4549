// Lengths as files state them: with the name of a unit, or as the extent of a whole grid.
#pragma once

#include "core/mathematics/units.hpp"
#include "surface/metres.hpp"

#include <cmath>
#include <limits>

namespace vkfv::surface {

inline constexpr double mm_per_nm = 1e-6;
inline constexpr const char* length_unit_names = "a unit of length: m, cm, mm, um, nm, pm or inch";

// A value of a unit (mm) in mm; values that a writer divided by `unit` are restored to the same bits (metres.hpp says
// why).
inline double mm_from(double value, double unit) {
    const double mm = value * unit;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (const double candidate : {mm, std::nextafter(mm, -infinity), std::nextafter(mm, infinity)})
        if (candidate / unit == value)
            return candidate;
    return mm;
}

// The height in mm; NaN, which means not measured, for all values that are not finite.
inline double height_from(double value, double unit) {
    const double mm = mm_from(value, unit);
    return std::isfinite(mm) ? mm : std::numeric_limits<double>::quiet_NaN();
}

// Values of at least this size mean "not measured": Surfer's 1.70141e38, the largest float, and all others beyond any
// length.
inline constexpr double not_measured_from = 1e37;

// Heights of at least this length (mm) are not measured either: a height below it is also below not_measured_from in
// micrometres, the unit of tables, and so reads back; the factor of a half keeps clear of rounding.
inline constexpr double no_height_from = 0.5 * not_measured_from / um_per_mm;

// The height in mm, in a format without a mark for gaps; NaN if the value is no height.
inline double measured_height(double value, double unit) {
    const double height = height_from(value, unit);
    return std::abs(value) < not_measured_from && std::abs(height) < no_height_from
               ? height
               : std::numeric_limits<double>::quiet_NaN();
}

// True if an option's length differs so much from the one in a file that the user should be warned; files and users
// round.
inline bool contradicts(double given, double stated) {
    constexpr double alike = 0.01;
    return std::abs(given - stated) > alike * std::abs(stated);
}

// True if a value is the file's mark for points that are not measured; files round it.
inline bool is_mark(double value, double mark) {
    constexpr double rounding = 1e-6;
    return std::abs(value - mark) <= rounding * std::abs(mark);
}

// The extent of the whole grid in metres, as Gwyddion's files state it.
inline double extent_from_pitch(double pitch, int points) {
    return metres_from_mm(pitch * points);
}

// The pitch in mm; one with the same extent_from_pitch() if there is one nearby.
inline double pitch_from_extent(double metres, int points) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    constexpr int steps = 4; // steps of rounding, more than both operations can lose
    const double pitch = metres * mm_per_metre / points;
    double below = pitch, above = pitch;
    for (int k = 0; k < steps; ++k) {
        for (const double candidate : {below, above})
            if (extent_from_pitch(candidate, points) == metres)
                return candidate;
        below = std::nextafter(below, -infinity);
        above = std::nextafter(above, infinity);
    }
    return pitch;
}

} // namespace vkfv::surface
