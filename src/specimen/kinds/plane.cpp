#include "specimen/kinds/plane.hpp"

#include "core/keys/section.hpp"

#include <cmath>

namespace vkfv::specimen {
namespace {

const auto slopes = NumberRange::within(-80, 80); // facets on steeper planes would not resolve the footprint

const NumberKey tilt_x_key("tilt_x_deg", slopes, 0.0, "Angle by which the plane rises along x.");
const NumberKey tilt_y_key("tilt_y_deg", slopes, 0.0, "Angle by which the plane rises along y.");

} // namespace

std::vector<const Key*> Plane::keys() {
    return continuous_keys({&tilt_x_key, &tilt_y_key});
}

Plane Plane::read(const Section& section) {
    Plane plane;
    read_continuous(section, plane);
    plane.tilt_x = section.number(tilt_x_key) * radians_per_degree;
    plane.tilt_y = section.number(tilt_y_key) * radians_per_degree;
    return plane;
}

Analytic Plane::function(const SourceLocation& where) const {
    for (const auto& [key, tilt] : {std::pair{"tilt_x_deg", tilt_x}, std::pair{"tilt_y_deg", tilt_y}}) {
        require(std::abs(tilt) < 0.5 * pi, where, key, tilt / radians_per_degree, "an angle below 90 degrees");
    }
    return function_of(physics::f64::SHAPE_PLANE, {std::tan(tilt_x), std::tan(tilt_y)});
}

dimensions::Flat Plane::feature() const {
    return {};
}

} // namespace vkfv::specimen
