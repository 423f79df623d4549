// How the maximum of a focus curve is found (shaders/focus/peak.glsl).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vkfv::topography {

// "gaussian" and "parabola": through the three values around the maximum. "gaussian-fit" and "polynomial-fit" (of
// degree 2: a higher one follows the noise): least squares over the range. "centre-of-gravity": over the range. In the
// order of the constants PEAK_*.
const std::vector<std::string>& peak_method_names();

// Its PEAK_*; InputError otherwise.
int peak_method_from_name(std::string_view name);

} // namespace vkfv::topography
