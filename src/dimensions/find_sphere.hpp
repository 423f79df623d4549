// A sphere whose position is not given: a cap upon a plane, a dimple in it, or a map that lies on a sphere altogether.
#pragma once

#include "dimensions/feature.hpp"

#include <optional>

namespace vkfv::dimensions {

// The cap and the tilted plane which together leave the least squares of the heights. A paraboloid upon a circle is
// fitted at all places and sizes first, so that no threshold of height decides what belongs to the cap. Then sphere and
// plane are fitted in turn, the sphere inside nine tenths of the rim and the plane beyond 1.05 of it, and the rim is
// where they meet, until it stays. The frame's origin is the rim's middle. A radius of 0 says that one sphere through
// all points leaves as little. None where the rim does not settle, where the heights, averaged over a
// thirty-second of the map against noise, are off the sphere by more than a tenth of its sag (root mean square), or
// where nothing was measured.
std::optional<SphereCap> found_sphere(const surface::HeightMap& map);

} // namespace vkfv::dimensions
