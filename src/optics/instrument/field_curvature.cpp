#include "optics/instrument/field_curvature.hpp"

#include "optics/instrument/instrument.hpp"

#include <glm/glm.hpp>

#include <cmath>

namespace vkfv::optics {

double FieldCurvature::height(double x, double y) const {
    const double squared = x * x + y * y;
    return squared * (quadratic + quartic * squared);
}

FieldCurvature field_curvature(const FirstOrder& first_order) {
    // relative, of squared distances; smaller ones yield rounding, not a quartic term
    constexpr double least_difference = 0.05;
    const double edge = first_order.field_edge * first_order.field_edge;
    const double corner = glm::dot(first_order.field_corner, first_order.field_corner);
    if (!(edge > 0) || !std::isfinite(first_order.field_curvature)) {
        return {};
    }
    const double at_edge = first_order.field_curvature / edge;
    const double at_corner = first_order.field_curvature_corner / corner;
    if (!(corner - edge > least_difference * edge) || !std::isfinite(at_corner)) {
        return {.quadratic = at_edge};
    }
    const double quartic = (at_corner - at_edge) / (corner - edge);
    return {.quadratic = at_edge - quartic * edge, .quartic = quartic};
}

} // namespace vkfv::optics
