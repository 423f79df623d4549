// How much of waves of many periods an instrument transfers: chirps and stars.
#pragma once

#include "dimensions/feature.hpp"
#include "dimensions/statistics.hpp"

#include <optional>
#include <vector>

namespace vkfv::dimensions {

// Of waves of one period: amplitude measured over nominal.
struct Transfer {
    double period = 0; // mm
    double ratio = surface::undefined;
    double standard_error = surface::undefined;
};

// Each whole wave of the chirp that lies in the map, from the lowest u on: a cosine and a sine of the nominal phase and
// a level are fitted to it in each profile across; cosine and sine are averaged over the profiles, and the ratio is
// that of their hypotenuse. Tilt is taken off the map first, fitted together with the whole chirp. Of a wave of which
// no profile has three quarters of its points the ratio is NaN.
std::vector<Transfer> chirp_transfer(const surface::HeightMap& map, const Chirp& chirp);

// The star's rings from its outer end to where a period is four points of the map: 12, at equal ratios of the radius,
// each a tenth of its radius wide. In each a level with a tilt and the harmonics 1, 3 and 5 of the petals are fitted;
// the ratio is that of the first one's amplitude to 2 |height| / pi, a square wave's. NaN of a ring that the map does
// not hold, or of which less than half was measured.
std::vector<Transfer> star_transfer(const surface::HeightMap& map, const Star& star);

// Where the ratio falls below one half, linear between neighbours, from long periods on; none where it stays above, or
// starts below: for stars the lateral period limit of ISO 25178-600.
std::optional<double> period_at_half(std::vector<Transfer> transfers);

} // namespace vkfv::dimensions
