// Lengths as files state them: with the name of a unit, or as the extent of a whole grid.
#pragma once

#include "core/mathematics/units.hpp"
#include "surface/metres.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

namespace vkfv::surface {

// mm per unit; the sign for micro as UTF-8, in both of Unicode's forms, as Latin-1 and as code page 437 of DOS.
inline constexpr std::array length_units = {std::pair{std::string_view("m"), 1e3},
                                            std::pair{std::string_view("cm"), 1e1},
                                            std::pair{std::string_view("mm"), 1.0},
                                            std::pair{std::string_view("um"), 1e-3},
                                            std::pair{std::string_view("\xC2\xB5m"), 1e-3},
                                            std::pair{std::string_view("\xCE\xBCm"), 1e-3},
                                            std::pair{std::string_view("\xB5m"), 1e-3},
                                            std::pair{std::string_view("\xE6m"), 1e-3},
                                            std::pair{std::string_view("nm"), 1e-6},
                                            std::pair{std::string_view("pm"), 1e-9},
                                            std::pair{std::string_view("inch"), 25.4},
                                            std::pair{std::string_view("\\u00B5m"), 1e-3}, // as Java programs escape it
                                            std::pair{std::string_view("micron"), 1e-3},
                                            std::pair{std::string_view("microns"), 1e-3}};
inline constexpr double mm_per_nm = 1e-6;
inline constexpr const char* length_unit_names = "a unit of length: m, cm, mm, um, nm, pm or inch";

inline std::optional<double> mm_per_unit(std::string_view name) {
    const auto unit = std::ranges::find(length_units, name, &std::pair<std::string_view, double>::first);
    return unit == length_units.end() ? std::nullopt : std::optional(unit->second);
}

// mm; those that a writer divided by `unit` come back to the same bits (metres.hpp says why).
inline double mm_from(double value, double unit) {
    const double mm = value * unit;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (const double candidate : {mm, std::nextafter(mm, -infinity), std::nextafter(mm, infinity)})
        if (candidate / unit == value)
            return candidate;
    return mm;
}

// NaN, which means not measured, for whatever is not finite.
inline double height_from(double value, double unit) {
    const double mm = mm_from(value, unit);
    return std::isfinite(mm) ? mm : std::numeric_limits<double>::quiet_NaN();
}

// Values of at least this size say "not measured": Surfer's 1.70141e38, the largest float, and all others that no
// length reaches.
inline constexpr double not_measured_from = 1e37;

// Heights of at least this length (mm) are not measured either: a height that was read is then below not_measured_from
// in micrometres too, which tables are written in, and reads back; half of it keeps clear of rounding.
inline constexpr double no_height_from = 0.5 * not_measured_from / um_per_mm;

// NaN where a value of a file whose formats have no mark of their own is no height, mm otherwise.
inline double measured_height(double value, double unit) {
    const double height = height_from(value, unit);
    return std::abs(value) < not_measured_from && std::abs(height) < no_height_from
               ? height
               : std::numeric_limits<double>::quiet_NaN();
}

// Whether an option's length is so far from the one that a file states that the user should hear of it; files and users
// round.
inline bool contradicts(double given, double stated) {
    constexpr double alike = 0.01;
    return std::abs(given - stated) > alike * std::abs(stated);
}

// Whether a value is the one that a file names for points that are not measured; files round it.
inline bool is_mark(double value, double mark) {
    constexpr double rounding = 1e-6;
    return std::abs(value - mark) <= rounding * std::abs(mark);
}

// Gwyddion's files state the whole grid's extent, in metres.
inline double extent_from_pitch(double pitch, int points) {
    return metres_from_mm(pitch * points);
}

// mm; what extent_from_pitch() made comes back to a pitch with the same extent.
inline double pitch_from_extent(double metres, int points) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    constexpr int steps = 4; // of rounding, more than both operations can lose
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
