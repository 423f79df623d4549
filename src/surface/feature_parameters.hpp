// Feature parameters of ISO 25178-2: hills and dales by watersheds.
#pragma once

#include "surface/height_map.hpp"

namespace vkfv::surface {

// Feature parameters in mm, 1/mm^2 and 1/mm; heights are relative to the mean height. NaN without measured points; spc
// also if no peak has measured neighbours on all four sides.
struct FeatureParameters {
    double s10z = undefined; // ten-point height, s5p + s5v
    double s5p = undefined;  // mean height of the five highest peaks, or of all if fewer
    double s5v = undefined;  // mean depth of the five deepest pits, or of all if fewer; positive
    double spd = undefined;  // peaks per area of the measured points
    double spc = undefined;  // mean of the peaks' curvature, -(d2z/dx2 + d2z/dy2) / 2, by central differences
};

// Finds hills and dales, with eight neighbours to a point. A peak is significant if it rises by at least this share of
// Sz above the saddle to a higher one (Wolf pruning: the hill of the least such rise joins its neighbour first). Hills
// at the map's border count. A hill isolated by gaps counts if it rises by as much above its own lowest point. The
// points are sorted once, and hills merge in descending order: O(N log N).
FeatureParameters feature_parameters(const HeightMap& map, double pruning = 0.05);

} // namespace vkfv::surface
