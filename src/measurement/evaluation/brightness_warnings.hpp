// A warning where brightness that changes with focus makes dimensions more uncertain than their standard errors tell.
#pragma once

#include "core/messages/warning.hpp"
#include "measurement/evaluation/evaluation.hpp"

#include <vector>

namespace vkfv::measurement {

// One warning for all dimensions whose uncertainty by brightness is more than twice their standard error; none without
// such dimensions.
std::vector<Warning> warnings_of_brightness(const Evaluation& evaluation);

} // namespace vkfv::measurement
