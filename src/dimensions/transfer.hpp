// The instrument transfer function at many periods, from chirps and stars.
#pragma once

#include "dimensions/feature.hpp"
#include "dimensions/statistics.hpp"

#include <optional>
#include <vector>

namespace vkfv::dimensions {

// The transfer of waves of one period: measured over nominal amplitude.
struct Transfer {
    double period = 0; // mm
    double ratio = surface::undefined;
    double standard_error = surface::undefined;
};

// The transfer of each whole wave of the chirp within the map, from the lowest u. In each profile across, a cosine and
// a sine of the nominal phase and a level are fitted to it; both are averaged over the profiles, and the ratio is that
// of their hypotenuse to the nominal amplitude. The tilt, fitted together with the whole chirp, is removed first. The
// ratio is NaN if no profile has three quarters of the wave's points.
std::vector<Transfer> chirp_transfer(const surface::HeightMap& map, const Chirp& chirp);

// The transfer in 12 rings of the star at equal ratios of the radius, each a tenth of its radius wide: from 0.9 of the
// star's radius, beyond which the rim is rounded, to where a period is four points of the map. In each ring a level
// with a tilt and those of the harmonics 1, 3 and 5 of the petals that the points resolve are fitted; the ratio is that
// of the first one's amplitude to 2 |height| / pi, that of a square wave. NaN for a ring of which less than half is in
// the map and measured.
std::vector<Transfer> star_transfer(const surface::HeightMap& map, const Star& star);

// The period at which the ratio falls below one half, linear between neighbours, from long periods downwards; none if
// it stays above, or starts below. For stars it is the lateral period limit of ISO 25178-600.
std::optional<double> period_at_half(std::vector<Transfer> transfers);

} // namespace vkfv::dimensions
