// Fills height maps at points that were not measured.
#pragma once

#include "surface/height_map.hpp"

namespace vkfv::surface {

// Interpolates not-measured points from the measured ones around them: coarse heights come from means over ever larger
// cells, and are then smoothed towards the mean of the four neighbours (Laplace's equation), so that a small gap in a
// plane is filled with the plane. Measured points do not change. A map without any measured point is returned
// unchanged.
HeightMap fill_not_measured(HeightMap map);

} // namespace vkfv::surface
