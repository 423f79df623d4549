// Flatness by the minimum zone (ISO 12781-1).
#pragma once

#include "surface/height_map.hpp"

namespace vkfv::surface {

// The least distance (mm, normal to the planes) of two parallel planes that enclose all measured points. NaN without
// measured points. By cutting planes: the tilt with the least range of a few points is found, then the points that
// exceed this range are added, until none exceeds it by more than a millionth of the zone. The range of points is a
// convex function of the tilt, so the result is the global minimum.
double minimum_zone(const HeightMap& map);

} // namespace vkfv::surface
