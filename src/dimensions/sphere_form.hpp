// Radius and form deviation of a spherical cap, and angles of a prism's flanks.
#pragma once

#include "dimensions/feature.hpp"
#include "dimensions/statistics.hpp"
#include "surface/sphere.hpp"

#include <optional>

namespace vkfv::dimensions {

// The least-squares sphere by orthogonal distances (surface/sphere.hpp), and the deviations from it. Lengths in mm.
struct SphereForm {
    surface::Sphere sphere;
    double radius_error = 0;   // standard error, for correlated residues (correlated_errors.hpp)
    double peak_to_valley = 0; // range of the points' signed distances from the sphere
    double rms = 0;
};

// The form of a cap, from the points nearer to the frame's origin than nine tenths of the cap's radius on the plane;
// flanks that were not measured are simply left out. None if less than a quarter of this circle was measured, or if no
// sphere is found.
std::optional<SphereForm> sphere_form(const surface::HeightMap& map, const SphereCap& cap);

// The form of a sphere through all measured points; none if no sphere is found.
std::optional<SphereForm> sphere_form(const surface::HeightMap& map);

// The angles of the two flanks to u (rad, positive), averaged over the profiles, from least-squares lines through each
// flank without the sixth of its length at either end. None if fewer than a fifth of the profiles have half of the
// points of a flank.
struct FlankAngles {
    Mean before; // at u < 0
    Mean behind;
};
std::optional<FlankAngles> flank_angles(const surface::HeightMap& map, const Prism& prism);

} // namespace vkfv::dimensions
