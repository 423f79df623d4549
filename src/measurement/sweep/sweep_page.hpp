// A sweep's report as one page: a matrix to click through.
#pragma once

#include "measurement/sweep/sweep_report.hpp"

namespace vkfv::measurement {

// HTML. Each combination links to its own report, or to its image. base: with what is not swept.
std::string sweep_page(const Sweep& sweep, const std::vector<SweepRow>& rows, const std::string& title,
                       const Configuration& base);

} // namespace vkfv::measurement
