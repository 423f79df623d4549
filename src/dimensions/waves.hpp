// Fits sinusoids to heights: amplitude and period.
#pragma once

#include "dimensions/feature.hpp"

#include <array>
#include <optional>
#include <vector>

namespace vkfv::dimensions {

// The wave amplitude * cos(2 pi (frequency . p) - phase), where p is the position in x and y relative to the frame's
// origin (mm).
struct Wave {
    std::array<double, 2> frequency{}; // cycles per mm along x and y
    double amplitude = 0;              // mm
    double phase = 0;                  // rad
    double amplitude_error = 0;        // standard errors, here and below
    double period_error = 0;

    double period() const { return 1 / std::hypot(frequency[0], frequency[1]); }
};

struct Waves {
    std::vector<Wave> waves;
    double residue = 0;     // root mean square, mm
    double angle_error = 0; // rad, standard error of the angle between two waves; 0 for another number of waves
};

// Fits waves by least squares to all measured points: frequency (both components), phase and amplitude of each wave,
// mean and tilt, by Gauss-Newton iteration. The iteration starts at the best of the given frequency and those a quarter
// and a half of a cycle over the map to either side of it, so the given one may be wrong by as much. Standard errors
// allow for the correlation of the residues (correlated_errors.hpp), after the part common to all periods is removed.
// None if the points determine no wave, if the map is shorter than one and a half periods, or if the iteration does not
// converge near the start.
std::optional<Waves> fitted_waves(const surface::HeightMap& map, const Frame& frame,
                                  const std::vector<std::array<double, 2>>& frequencies);

// Fits one wave as a function of the distance from the frame's origin, as fitted_waves() does; only frequency[0] is
// used.
std::optional<Waves> fitted_radial_wave(const surface::HeightMap& map, const Frame& frame, double frequency);

// The frequency along x and y (cycles per mm) of the map's strongest wave, from the Fourier transform of its levelled
// heights, to within half a cycle over the map; none for a level map. `apart`: a frequency whose direction the result
// differs from by at least 20 degrees.
std::optional<std::array<double, 2>> strongest_frequency(const surface::HeightMap& map,
                                                         const std::optional<std::array<double, 2>>& apart = {});

} // namespace vkfv::dimensions
