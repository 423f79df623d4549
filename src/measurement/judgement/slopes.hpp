// The specimen's slopes, and the steepest slope that the instrument sees.
#pragma once

#include "measurement/judgement/expectation.hpp"

namespace vkfv::measurement {

// Sets the shares of the points by slope, the steepest facet that is seen, and the share of the field that can be
// measured. Slopes are differences of neighbouring pixels' true heights. The light that a facet sends into the
// objective is found by paths of the traced physics from the source's cone (a ring's middle line, all around),
// scattered by the facet's material. The evaluation counts a point as dark (PointState::dark) below a hundredth of the
// most light.
void expect_slopes(const Configuration& configuration, const optics::Instrument& instrument,
                   const specimen::Specimen& specimen, Expectation& expected);

} // namespace vkfv::measurement
