// Facts shared by MetroPro's binary and text files.
#pragma once

#include "surface_files/provenance.hpp"

#include <array>
#include <chrono>
#include <cstdint>
#include <string>

namespace vkfv::surface::metropro {

// Steps of a phase wave, indexed by the file's number for the phases' resolution.
inline constexpr std::array resolutions = {4096, 32768, 131072};
// Phases of at least this value are not measured.
inline constexpr std::int32_t first_not_measured = 2147483640;

// A date in seconds since 1970 as xsd:dateTime; empty for a date that is unknown.
inline std::string date_after_1970(std::int32_t seconds) {
    using namespace std::chrono;
    const sys_seconds time{std::chrono::seconds(seconds)};
    const auto day = floor<days>(time);
    const year_month_day date(day);
    const hh_mm_ss clock(time - day);
    const DateTime parts{int{date.year()},
                         static_cast<int>(unsigned{date.month()}),
                         static_cast<int>(unsigned{date.day()}),
                         static_cast<int>(clock.hours().count()),
                         static_cast<int>(clock.minutes().count()),
                         static_cast<int>(clock.seconds().count())};
    return parts.valid() ? known_date(parts.text()) : std::string();
}

} // namespace vkfv::surface::metropro
