// Spatial parameters of ISO 25178-2:2012, 4.2 and 4.5.
#pragma once

#include "surface/height_map.hpp"

namespace vkfv::surface {

// Heights are taken from their mean; form and tilt are the caller's business. NaN for what is undefined: of a
// constant height, and where the autocorrelation does not fall as said below.
//
// The autocorrelation at a lag is the mean product of all pairs of measured points so far apart, over the mean
// square: no periodic wrap, and normalised by the overlap, so that neither borders nor not-measured points pull it to
// zero. Lags reach to half of either extent. Along every direction the first fall to s = 0.2 counts.
struct SpatialParameters {
    double sal = 0;       // autocorrelation length, mm: the shortest of these falls
    double str = 0;       // texture aspect ratio: the shortest over the longest; NaN where a direction has no fall
    double std_angle = 0; // Std, texture direction: of the lay, from +x towards +y, radians in (-pi/2, pi/2]
};

// Std is at right angles to the direction in which the angular spectrum (the power spectrum under a Hann window,
// integrated along the radius) is greatest, between twice the longer fundamental frequency, below which the window
// spreads the mean, and the Nyquist frequency of the coarser pitch. Not-measured points count as the mean height there.
// Works in 36 bytes a point besides the map.
SpatialParameters spatial_parameters(const HeightMap& map);

} // namespace vkfv::surface
