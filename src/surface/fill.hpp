// Heights for points that were not measured, where something must stand there.
#pragma once

#include "surface/height_map.hpp"

namespace vkfv::surface {

// Interpolates not-measured points from the measured ones around them: coarse first, by means over ever larger cells,
// then smoothed towards the mean of the four neighbours (Laplace's equation), so that a small gap in a plane is filled
// with the plane. Measured points stay as they are. Without any measured point the map comes back as it is.
HeightMap fill_not_measured(HeightMap map);

} // namespace vkfv::surface
