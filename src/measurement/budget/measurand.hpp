// The quantity that a budget is of: a dimension of the specimen, or a parameter of its surface.
#pragma once

#include "measurement/evaluation/evaluation.hpp"

#include <optional>
#include <string>
#include <vector>

namespace vkfv::measurement {

struct MeasurandValue {
    std::string name; // "groove depth", "Sq"
    std::string unit; // "um", "deg", "um3/um2", ...; empty: none
    double measured;
    double truth; // by the same rule on the true surface

    double error() const { return measured - truth; }
};

// The value by its name, or by the beginning of a dimension's. None if the stack measured no such quantity, or it has
// no truth.
std::optional<MeasurandValue> measurand(const Evaluation& evaluation, const std::string& name);

// The names of all quantities that the stack measured.
std::vector<std::string> measurands(const Evaluation& evaluation);

} // namespace vkfv::measurement
