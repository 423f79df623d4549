// Units are converted once, at input and output: internally lengths are millimetres, angles radians, power watts; only
// wavelengths are micrometres.
#pragma once

namespace vkfv {

inline constexpr double pi = 3.14159265358979323846;
inline constexpr double mm_per_um = 1e-3;
inline constexpr double um_per_mm = 1e3;
inline constexpr double radians_per_degree = pi / 180.0;

// Converts um to mm. Division rounds 0.8 um to the double nearest 0.0008.
constexpr double from_um(double um) {
    return um / um_per_mm;
}

} // namespace vkfv
