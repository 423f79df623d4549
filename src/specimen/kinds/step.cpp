#include "specimen/kinds/step.hpp"

#include "core/keys/section.hpp"

#include <cmath>

namespace vkfv::specimen {
namespace {

const NumberKey step_height_key = for_example(
    "2.0", NumberKey("height_um", NumberRange::finite(), needed, "Of the level at x > 0 over that at x < 0."));
const NumberKey step_wall_key("wall_um", NumberRange::at_least(0), 0.0, "Width of the flank; 0: one pitch.");

} // namespace

std::vector<const Key*> Step::keys() {
    return continuous_keys({&step_height_key, &step_wall_key});
}

Step Step::read(const Section& section) {
    Step step;
    read_continuous(section, step);
    step.height = from_um(section.number(step_height_key));
    step.wall = from_um(section.number(step_wall_key));
    return step;
}

Analytic Step::function(const SourceLocation& where) const {
    require_um(std::isfinite(height), where, "height_um", height, "a finite length");
    const double flank = wall == 0 ? pitch : wall;
    require_um(positive(flank), where, wall == 0 ? "pitch_um" : "wall_um", flank, positive_um());
    return function_of(physics::f64::SHAPE_STEP, {height, flank});
}

dimensions::Step Step::feature() const {
    return {.frame = {}, .height = height};
}

} // namespace vkfv::specimen
