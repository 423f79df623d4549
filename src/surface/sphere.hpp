// Form removal by a sphere.
#pragma once

#include "surface/height_map.hpp"

namespace vkfv::surface {

// The upper or the lower half of a sphere's surface. mm.
struct Sphere {
    double x_centre = 0;
    double y_centre = 0;
    double apex = 0;    // height of the pole that the surface has: its top if convex, its bottom otherwise
    double radius = 0;  // positive
    bool convex = true; // the centre lies below the surface

    // NaN beyond the radius.
    double height(double x, double y) const;
};

// The sphere with the least sum of squared distances from the measured points, along its normal and not along z:
// steep flanks weigh no more than the pole. By Gauss and Newton's iteration from the algebraic fit. A radius of NaN
// says that the points settle no sphere: too few, on one plane, or the iteration found no end.
Sphere least_squares_sphere(const HeightMap& map);

// Along z. Points beyond the sphere's radius become not measured.
HeightMap remove_sphere(HeightMap map, const Sphere& sphere);

} // namespace vkfv::surface
