// The limits of a focus-variation instrument in closed form, as bounds of a sinusoid's wavelength and amplitude.
#pragma once

#include "measurement/calibration/tested_instrument.hpp"
#include "topography/focus_measure.hpp"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv::measurement {

// A sinusoidal surface. mm.
struct SurfaceWave {
    double length = 0; // its wavelength
    double amplitude = 0;

    double steepest_slope() const; // 2 pi A / lambda, dimensionless
};

// The properties of an instrument that its limits are computed from. Lengths are in mm.
struct LimitingProperties {
    double pixel = 0;  // distance of the pixels on the specimen
    double window = 0; // width of the focus window
    topography::WindowShape window_shape = topography::WindowShape::box;
    double window_period = 0;      // period_of_half_in_window()
    double window_deviation = 0;   // standard deviation of the places in the window along a line, by their weights
    double resolution = 0;         // 0.61 times the wavelength of the light over the numerical aperture
    double numerical_aperture = 0; // object side, n sin(theta)
    double object_index = 1;       // of the medium over the specimen (n)
    double curve_deviation = 0;    // standard deviation of a focus curve
    double range = 0;              // way of the scan
    double usable_range = 0;       // the same less two standard deviations of a focus curve at either end
    double noise = 0;              // standard deviation of a height; NaN: not known, and no limit
};

// The nesting index (mm) of an S-filter that takes short waves off as window and optics do: the larger of their
// periods.
double lost_period(const LimitingProperties& properties);

// shape: of the focus window. noise: of a height, mm; NaN: not known.
LimitingProperties limiting_properties(const TestedInstrument& instrument, topography::WindowShape shape, double noise);

// One limit of the instrument.
//
// window: the mean over the focus window leaves less than half of the amplitude (sin x / x with x = pi W / lambda for a
//   box). A transfer of one half is the lateral period limit of ISO 25178-600.
// optics: the print on the surface is not resolved within a wave, lambda < 0.61 lambda_light / NA (Lord Rayleigh 1879).
// slope: a smooth surface reflects no light of the objective's cone back into it, 2 pi A / lambda > tan(asin(NA / n)),
//   since NA = n sin(theta) (R. Leach (ed.), "Optical measurement of surface topography", 2011, chapter 1). Light that
//   is scattered comes back from steeper slopes too.
// relief: on a slope s the heights within a window have the standard deviation s d, where d is that of their places
//   along the slope: W / sqrt(12) for a box of width W, W / 5 for a Gaussian (topography::FocusWindow). The focus curve
//   of the window is the mean of curves of deviation w at these heights, whose variance is w^2 + s^2 d^2. The limit is
//   where both parts are equal: the curve is wider by sqrt(2) and lower by as much, and texture that lies unevenly in
//   the window displaces it by a large part of the relief.
// noise: the amplitude is less than three standard deviations of a height, the usual limit of detection.
// scan: the wave is higher than the usable range of the scan, 2 A > R - 4 w.
struct Limit {
    enum class Kind { least_length, largest_amplitude, least_amplitude };
    const char* key;        // in capability.json
    const char* title;      // on the page
    const char* needed_key; // of the property that would have to change: "pixel_um", "numerical_aperture"
    const char* remedy;     // the same in words, before the number
    // The equation of the bound, for readers.
    const char* (*equation)(const LimitingProperties& properties);
    Kind kind;
    double LimitingProperties::*property; // the same as it is
    // The bound, mm: of the wavelength, or of the amplitude at this wavelength.
    double (*bound)(const LimitingProperties& properties, double length);
    // The needed property (mm, or a numerical aperture) with which the wave lies on the bound, all else unchanged.
    double (*needed)(const LimitingProperties& properties, const SurfaceWave& wave);

    bool passed(const LimitingProperties& properties, const SurfaceWave& wave) const;
};

const std::array<Limit, 6>& limits();

// The limit of this key; std::out_of_range for any other.
const Limit& limit_named(std::string_view key);

// The limits that the wave lies beyond.
std::vector<const Limit*> passed_limits(const LimitingProperties& properties, const SurfaceWave& wave);

// A property in the unit of its key: um, or none for the numerical aperture.
double in_unit_of_key(const Limit& limit, double value);

// The keys of these limits.
std::vector<std::string> keys_of(const std::vector<const Limit*>& passed);

} // namespace vkfv::measurement
