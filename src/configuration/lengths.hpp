// Ranges and units that several tables share.
#pragma once

#include "core/toml_reader.hpp"
#include "core/units.hpp"

#include <cstdint>

namespace vkfv {

inline constexpr NumberRange share_range = {.minimum = 0, .maximum = 1, .minimum_included = false};
inline constexpr NumberRange wavelength_range_um = {.minimum = 0.1, .maximum = 100}; // wide of every glass
inline constexpr NumberRange tilt_range_deg = {.minimum = -360, .maximum = 360};
inline constexpr std::int64_t largest_seed = 0xffffffffll; // seeds are 32-bit words of the counter-based generator

// Division rounds 0.8 um to the double nearest 0.0008.
inline double from_um(double value) {
    return value / um_per_mm;
}

} // namespace vkfv
