// The report of a sweep as one page with a matrix of its combinations.
#pragma once

#include "measurement/sweep/sweep_report.hpp"

namespace vkfv::measurement {

// Returns HTML. Each combination links to its own report, or to its image. base: the configuration with all values that
// are not swept.
std::string sweep_page(const Sweep& sweep, const std::vector<SweepRow>& rows, const std::string& title,
                       const Configuration& base);

} // namespace vkfv::measurement
