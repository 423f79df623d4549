// Ranges and units that several tables share.
#pragma once

#include "core/mathematics/units.hpp"
#include "core/toml/toml_reader.hpp"

#include <cstdint>

namespace vkfv {

inline constexpr NumberRange share_range = {.minimum = 0, .maximum = 1, .minimum_included = false};
inline constexpr NumberRange wavelength_range_um = {.minimum = 0.1, .maximum = 100}; // wider than every glass's range
inline constexpr NumberRange tilt_range_deg = {.minimum = -360, .maximum = 360};
inline constexpr std::int64_t largest_seed = 0xffffffffll; // of 32-bit words, as the generator takes

} // namespace vkfv
