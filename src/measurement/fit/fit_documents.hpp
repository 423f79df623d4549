// The documents of a fit.
#pragma once

#include "measurement/fit/fit.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace vkfv::measurement {

// Sentences on the fit: whether the model describes the stack, what the stack does not tell, and which parameters it
// tells together only.
std::vector<std::string> remarks_of(const Fit& fit);

nlohmann::ordered_json fit_json(const Fit& fit);

// fit.html: remarks, the table of parameters, correlations, and each statistic along the scan. configuration: TOML.
std::string fit_page(const Fit& fit, const std::string& configuration);

} // namespace vkfv::measurement
