#include "specimen/kinds/sphere.hpp"

#include "core/keys/section.hpp"

#include <cmath>

namespace vkfv::specimen {
namespace {

const NumberKey sphere_radius_key =
    for_example("100.0", NumberKey("radius_um", NumberRange::positive(), needed, "Of the sphere."));
const NumberKey sphere_height_key =
    for_example("10.0", NumberKey("height_um", NumberRange::finite(), needed,
                                  "Of the cap over the plane, less than the radius; negative: a dimple."));

} // namespace

std::vector<const Key*> Sphere::keys() {
    return continuous_keys({&sphere_radius_key, &sphere_height_key});
}

Sphere Sphere::read(const Section& section) {
    Sphere sphere;
    read_continuous(section, sphere);
    sphere.radius = from_um(section.number(sphere_radius_key));
    sphere.height = from_um(section.number(sphere_height_key));
    return sphere;
}

Analytic Sphere::function(const SourceLocation& where) const {
    require_um(positive(radius), where, "radius_um", radius, positive_um());
    require_um(std::abs(height) < radius, where, "height_um", height, "less than the radius in size");
    return function_of(physics::f64::SHAPE_SPHERE, {radius, height});
}

dimensions::SphereCap Sphere::feature() const {
    return {.frame = {}, .radius = radius, .height = height};
}

} // namespace vkfv::specimen
