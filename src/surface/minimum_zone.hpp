// Flatness by the minimum zone (ISO 12781-1).
#pragma once

#include "surface/height_map.hpp"

namespace vkfv::surface {

// The least distance of two parallel planes that hold all measured points between them, mm, across the planes. NaN
// without measured points. By cutting planes: the tilt with the least range of a few points is found, the points that
// stand out of it are added, until none does by more than a millionth of the zone. The range of points is a convex
// function of the tilt, so that what is found is the least of all.
double minimum_zone(const HeightMap& map);

} // namespace vkfv::surface
