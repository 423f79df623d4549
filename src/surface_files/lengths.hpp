// Lengths as files state them: with the name of a unit, or as the extent of a whole grid.
#pragma once

#include "core/mathematics/units.hpp"
#include "surface/metres.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace vkfv::surface {

// Units by name, in mm; the micro sign as UTF-8, in both of Unicode's forms, as Latin-1 and as code page 437 of DOS;
// the angstrom in both of Unicode's forms.
inline constexpr std::array length_units = {
    std::pair{std::string_view("m"), 1e3},          std::pair{std::string_view("cm"), 1e1},
    std::pair{std::string_view("mm"), 1.0},         std::pair{std::string_view("um"), 1e-3},
    std::pair{std::string_view("\xC2\xB5m"), 1e-3}, std::pair{std::string_view("\xCE\xBCm"), 1e-3},
    std::pair{std::string_view("\xB5m"), 1e-3},     std::pair{std::string_view("\xE6m"), 1e-3},
    std::pair{std::string_view("nm"), 1e-6},        std::pair{std::string_view("pm"), 1e-9},
    std::pair{std::string_view("inch"), 25.4},      std::pair{std::string_view("inches"), 25.4},
    std::pair{std::string_view("\\u00B5m"), 1e-3}, // as Java programs escape it
    std::pair{std::string_view("micron"), 1e-3},    std::pair{std::string_view("microns"), 1e-3},
    std::pair{std::string_view("\xC3\x85"), 1e-7},  std::pair{std::string_view("\xE2\x84\xAB"), 1e-7},
    std::pair{std::string_view("angstrom"), 1e-7},  std::pair{std::string_view("in"), 25.4},
    std::pair{std::string_view("mil"), 0.0254}};
inline constexpr double mm_per_nm = 1e-6;
inline constexpr const char* length_unit_names = "a unit of length: m, cm, mm, um, nm, pm or inch";

// The size of a unit in mm, also by its whole name, in the plural and in capital letters ("Micrometers", "NM"); none
// for another word. A lone M is no metre.
inline std::optional<double> mm_per_unit(std::string_view name) {
    const auto size_of = [](std::string_view known) {
        const auto unit = std::ranges::find(length_units, known, &std::pair<std::string_view, double>::first);
        return unit == length_units.end() ? std::nullopt : std::optional(unit->second);
    };
    if (const auto size = size_of(name))
        return size;
    std::string word;
    for (const char c : name)
        word += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    if (const auto size = word.size() > 1 ? size_of(word) : std::nullopt)
        return size;
    if (word.ends_with('s'))
        word.pop_back();
    for (const std::string_view metre : {"metre", "meter"})
        if (word.ends_with(metre)) {
            const std::string prefix = word.substr(0, word.size() - metre.size());
            return prefix.empty()      ? size_of("m")
                   : prefix == "centi" ? size_of("cm")
                   : prefix == "milli" ? size_of("mm")
                   : prefix == "micro" ? size_of("um")
                   : prefix == "nano"  ? size_of("nm")
                   : prefix == "pico"  ? size_of("pm")
                                       : std::nullopt;
        }
    return word.size() > 1 ? size_of(word) : std::nullopt;
}

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
