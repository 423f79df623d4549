// Where a focus curve lies whose maximum the averages along z bring to a point. Away from the ends that is the point.
// Near them less is averaged the nearer the end, so that what lies there stands higher: a maximum moves towards the
// end, by up to a third of the curve's standard deviation.
#pragma once

#include "topography/peak_method.hpp"

#include <vector>

namespace vkfv::topography {

// How the maximum of a curve is found.
struct PeakFinder {
    PeakMethod method = PeakMethod::gaussian;
    int range = 1; // steps on either side
};

// For every point of the curve, in steps of the scan and inside it: the middle of that Gaussian of the standard
// deviation curve_width (steps) whose maximum, after both averages by these weights (axial_weights()), is found there.
// Points that none comes to follow in the distances of averaged_points(). curve_width 0: those points themselves.
std::vector<double> places_of_maxima(const std::vector<double>& weights, int images, double curve_width,
                                     const PeakFinder& finder);

} // namespace vkfv::topography
