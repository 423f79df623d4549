// Methods to find the maximum of a focus curve (shaders/focus/peak.glsl).
#pragma once

#include "focus/focus.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace vkfv::topography {

// Values are the constants PEAK_*.
enum class PeakMethod {
    gaussian = focus::f64::PEAK_GAUSSIAN,                   // through the three values around the maximum
    parabola = focus::f64::PEAK_PARABOLA,                   // through the three values around the maximum
    gaussian_fit = focus::f64::PEAK_GAUSSIAN_FIT,           // least squares over the range
    polynomial_fit = focus::f64::PEAK_POLYNOMIAL_FIT,       // least squares, degree 2: a higher one follows the noise
    centre_of_gravity = focus::f64::PEAK_CENTRE_OF_GRAVITY, // over the range
};

// The names of the methods in the order of PeakMethod: "gaussian", "parabola", "gaussian-fit", "polynomial-fit",
// "centre-of-gravity".
const std::vector<std::string>& peak_method_names();
const std::string& name_of(PeakMethod method);
// The method with this name; InputError for any other name.
PeakMethod peak_method_from_name(std::string_view name);

} // namespace vkfv::topography
