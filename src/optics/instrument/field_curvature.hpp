// The surface of best focus over the field: its height is subtracted from every measured height, unless a flat corrects
// it.
#pragma once

namespace vkfv::optics {

struct FirstOrder;

// An even polynomial of the distance from the axis: third-order curvature of the field is quadratic in it (Born and
// Wolf, "Principles of Optics", section 5.3), the next order quartic.
struct FieldCurvature {
    double quadratic = 0; // 1/mm
    double quartic = 0;   // 1/mm^3

    // The height (mm) of best focus above that on the axis; x and y: mm from the axis on the object plane.
    double height(double x, double y) const;
};

// The polynomial through the best focus traced at the edge and in the corner of the field (best_focus.hpp). A detector
// so narrow that both are at nearly the same distance, or a corner without light, leaves the quadratic term alone. Odd
// terms, which displaced parts cause, are not modelled.
FieldCurvature field_curvature(const FirstOrder& first_order);

} // namespace vkfv::optics
