// The surface of best focus over the field: what an instrument takes off every height unless a flat corrects it.
#pragma once

namespace vkfv::optics {

struct FirstOrder;

// An even polynomial of the distance from the axis: curvature of the field goes with its square in the third order
// (Born and Wolf, "Principles of Optics", section 5.3), and with its fourth power too in the next.
struct FieldCurvature {
    double quadratic = 0; // 1/mm
    double quartic = 0;   // 1/mm^3

    // Of best focus above that on the axis, mm; x and y from the axis on the object plane, mm.
    double height(double x, double y) const;
};

// Through the best focus that was traced at the edge and in the corner of the field (best_focus.hpp: by waves). A
// detector so narrow that both are alike, or a corner without light, leaves the quadratic term. What is not even,
// of displaced parts, is not in it.
FieldCurvature field_curvature(const FirstOrder& first_order);

} // namespace vkfv::optics
