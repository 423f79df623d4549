// Finds a sphere of unknown position: a cap on a plane, a dimple in it, or a map that lies on a sphere altogether.
#pragma once

#include "dimensions/feature.hpp"

#include <optional>

namespace vkfv::dimensions {

// Finds the cap and the tilted plane which together give the least squares of the heights. A paraboloid over a circle
// is first fitted at all places and sizes, so that no height threshold decides which points belong to the cap. Then
// sphere and plane are fitted in turn, the sphere within nine tenths of the rim and the plane beyond 1.05 of it, with
// the rim where they meet, until the rim is stable. The frame's origin is the rim's centre. A radius of 0 means that
// one sphere through all points leaves as little residual. None if the rim does not converge, if the root mean square
// deviation from the sphere of heights averaged over a thirty-second of the map (to reduce noise) exceeds a tenth of
// the sag, or if nothing was measured.
std::optional<SphereCap> found_sphere(const surface::HeightMap& map);

} // namespace vkfv::dimensions
