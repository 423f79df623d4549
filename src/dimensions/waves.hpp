// Sinusoids fitted to heights: amplitude and period.
#pragma once

#include "dimensions/feature.hpp"

#include <array>
#include <optional>
#include <vector>

namespace vkfv::dimensions {

// amplitude * cos(2 pi (frequency . p) - phase), p of the map's x and y about the frame's origin, mm.
struct Wave {
    std::array<double, 2> frequency{}; // cycles per mm along x and y
    double amplitude = 0;              // mm
    double phase = 0;                  // rad
    double amplitude_error = 0;        // standard errors
    double period_error = 0;

    double period() const { return 1 / std::hypot(frequency[0], frequency[1]); }
};

struct Waves {
    std::vector<Wave> waves;
    double residue = 0;     // root mean square, mm
    double angle_error = 0; // standard error of the angle between two waves, rad; 0 for another number of them
};

// Least squares over all measured points: frequency (both components), phase and amplitude of each wave, mean and tilt,
// by Gauss and Newton's iteration. Frequencies start at those given, a quarter of a cycle over the map to either side
// of them, or a half, and may be wrong by as much. Standard errors are the fit's for errors that are
// correlated as the residues are (correlated_errors.hpp), less what all periods have in common. None where the points
// settle no wave, where the map is shorter than a period and a half, or the iteration ends elsewhere.
std::optional<Waves> fitted_waves(const surface::HeightMap& map, const Frame& frame,
                                  const std::vector<std::array<double, 2>>& frequencies);

// The same of one wave over the distance from the frame's origin: frequency[0] alone counts.
std::optional<Waves> fitted_radial_wave(const surface::HeightMap& map, const Frame& frame, double frequency);

// The frequency along x and y of the map's strongest wave, from the Fourier transform of its levelled heights, in
// cycles per mm, to within half a cycle over the map; none in a level map. `apart`: the strongest that is at least
// 20 degrees off this direction.
std::optional<std::array<double, 2>> strongest_frequency(const surface::HeightMap& map,
                                                         const std::optional<std::array<double, 2>>& apart = {});

} // namespace vkfv::dimensions
