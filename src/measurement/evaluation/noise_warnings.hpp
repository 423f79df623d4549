// Warnings about the noise that the rays left in a stack's images.
#pragma once

#include "configuration/configuration.hpp"
#include "core/messages/warning.hpp"
#include "measurement/evaluation/evaluation.hpp"

#include <vector>

namespace vkfv::measurement {

// Warns where the images' noise is a large share of their brightness or, without a camera, scatters the heights by a
// large share of the focus curves' width (noise_limits). The configuration must have a scan.
std::vector<Warning> warnings_of_noise(const Configuration& configuration, const Evaluation& evaluation);

} // namespace vkfv::measurement
