// Radius and form deviation of a spherical cap, and angles of a prism's flanks.
#pragma once

#include "dimensions/feature.hpp"
#include "dimensions/statistics.hpp"
#include "surface/sphere.hpp"

#include <optional>

namespace vkfv::dimensions {

// Of the least-squares sphere by orthogonal distances (surface/sphere.hpp). Lengths in mm.
struct SphereForm {
    surface::Sphere sphere;
    double radius_error = 0;   // standard error, for residues whose correlation is found (statistics.hpp)
    double peak_to_valley = 0; // of the points' distances from it along its normals
    double rms = 0;
};

// Of the points nearer to the frame's origin than nine tenths of the cap's radius on the plane: flanks that were not
// measured are merely left out. None where less than a quarter of this circle was measured, or no sphere is found.
std::optional<SphereForm> sphere_form(const surface::HeightMap& map, const SphereCap& cap);

// Of all measured points.
std::optional<SphereForm> sphere_form(const surface::HeightMap& map);

// Angles of the two flanks against u, rad, positive, mean over the profiles: least-squares lines through what is left
// of a flank without the sixth of its length at either end. None where fewer than a fifth of the profiles have half of
// the points of both flanks.
struct FlankAngles {
    Mean before; // at u < 0
    Mean behind;
};
std::optional<FlankAngles> flank_angles(const surface::HeightMap& map, const Prism& prism);

} // namespace vkfv::dimensions
