// Form removal by a sphere.
#pragma once

#include "surface/height_map.hpp"

namespace vkfv::surface {

// The upper or the lower half of a sphere's surface, in mm.
struct Sphere {
    double x_centre = 0;
    double y_centre = 0;
    double apex = 0;    // height of the pole on the surface: the top if convex, else the bottom
    double radius = 0;  // positive
    bool convex = true; // true if the centre lies below the surface

    // The height at a place; NaN beyond the radius.
    double height(double x, double y) const;
};

// The sphere with the least sum of squared distances from the measured points, along its normal and not along z: steep
// flanks weigh no more than the pole. It is found by Gauss-Newton iteration from the algebraic fit. The radius is NaN
// if the points determine no sphere: too few points, points on one plane, or no convergence.
Sphere least_squares_sphere(const HeightMap& map);

// Subtracts the sphere along z. Points beyond its radius become not measured.
HeightMap remove_sphere(HeightMap map, const Sphere& sphere);

} // namespace vkfv::surface
