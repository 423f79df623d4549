// Warnings about the noise that the rays left in a stack's images.
#pragma once

#include "configuration/configuration.hpp"
#include "core/messages/warning.hpp"
#include "measurement/evaluation/evaluation.hpp"

#include <vector>

namespace vkfv::measurement {

// Warns where the rays' noise is most of what is measured, or coarse beside the focus curves. The configuration has a
// scan.
std::vector<Warning> warnings_of_noise(const Configuration& configuration, const Evaluation& evaluation);

} // namespace vkfv::measurement
