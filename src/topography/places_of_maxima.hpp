// Where a focus curve lies whose maximum the averages along z bring to a point. Away from the ends that is the point.
// Near them less is averaged the nearer the end, so that what lies there stands higher: a maximum moves towards the
// end, by up to a third of the curve's standard deviation.
#pragma once

#include <vector>

namespace vkfv::topography {

// For every point of the curve, in steps of the scan: the middle of that Gaussian of the standard deviation curve_width
// (steps) whose maximum both averages by these weights (axial_weights()) bring there. curve_width 0, and points that no
// maximum comes to: what the averages make of a straight line (AveragedPoint::position).
std::vector<double> places_of_maxima(const std::vector<double>& weights, int images, double curve_width);

} // namespace vkfv::topography
