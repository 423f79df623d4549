// How steep the specimen is, and how steep it may be to be seen.
#pragma once

#include "measurement/judgement/expectation.hpp"

namespace vkfv::measurement {

// Sets the shares of the points by slope, the steepest facet that is seen, and the share of the field that can be
// measured. Slopes are differences of neighbouring pixels' true heights. How much light a facet sends into the
// objective is found by paths of the physics of the trace, from the source's cone (a ring's: its middle line, all
// around) scattered by the facet's material; below a hundredth of the most the evaluation counts a point as dark
// (PointState::dark).
void expect_slopes(const Configuration& configuration, const optics::Instrument& instrument,
                   const specimen::Specimen& specimen, Expectation& expected);

} // namespace vkfv::measurement
