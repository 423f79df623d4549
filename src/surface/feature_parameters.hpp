// Feature parameters of ISO 25178-2: hills and dales by watersheds.
#pragma once

#include "surface/height_map.hpp"

namespace vkfv::surface {

// mm, 1/mm^2, 1/mm; heights from the mean height. NaN without measured points, spc too where no peak has measured
// neighbours on all four sides.
struct FeatureParameters {
    double s10z = undefined; // ten-point height, s5p + s5v
    double s5p = undefined;  // mean of the five highest peaks' heights; of all where there are fewer
    double s5v = undefined;  // mean of the five deepest pits' depths, positive; of all where there are fewer
    double spd = undefined;  // peaks per area of the measured points
    double spc = undefined;  // mean of the peaks' curvature, -(d2z/dx2 + d2z/dy2) / 2, by central differences
};

// A peak counts if it rises by at least this share of Sz over the saddle to a higher one (Wolf pruning: the hill of the
// least such rise joins its neighbour first). A point has eight neighbours. Hills at the map's border count. What gaps
// cut off counts as a hill if it rises by as much over its own lowest point. The points are sorted once, and hills
// joined in descending order: O(N log N).
FeatureParameters feature_parameters(const HeightMap& map, double pruning = 0.05);

} // namespace vkfv::surface
