// Spatial parameters of ISO 25178-2:2012, 4.2 and 4.5.
#pragma once

#include "surface/height_map.hpp"

namespace vkfv::surface {

// Spatial parameters of heights relative to their mean; form and tilt are the caller's task. NaN for undefined ones: of
// a constant height, and if the autocorrelation does not fall in the way described here.
//
// The autocorrelation at a lag is the mean product of all pairs of measured points at this distance, over the mean
// square: it does not wrap, and it is normalised by the overlap, so that neither borders nor not-measured points pull
// it to zero. Lags reach to half of either extent. Along every direction the first fall to s = 0.2 counts.
struct SpatialParameters {
    double sal = 0;       // autocorrelation length, mm: the shortest fall
    double str = 0;       // texture aspect ratio: the shortest fall over the longest; NaN if a direction has none
    double std_angle = 0; // Std, direction of the lay, from +x towards +y, radians in (-pi/2, pi/2]
};

// Computes the spatial parameters. Std is at right angles to the direction in which the angular spectrum (the power
// spectrum under a Hann window, integrated along the radius) is greatest, between twice the longer fundamental
// frequency, below which the window spreads the mean, and the Nyquist frequency of the coarser pitch. Not-measured
// points count as the mean height there. The working memory is 36 bytes a point besides the map.
SpatialParameters spatial_parameters(const HeightMap& map);

} // namespace vkfv::surface
