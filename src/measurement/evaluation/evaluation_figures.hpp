// The figures of an evaluation.
#pragma once

#include "measurement/evaluation/evaluation.hpp"
#include "report/parameter_table.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <vector>

namespace vkfv::measurement {

struct Figures {
    topography::Band band; // what was done to the measured heights and to the truth
    double measured_share = 0;
    std::optional<topography::Deviation> deviation; // none without a truth
    std::vector<report::ParameterRow> measured;     // ISO 25178-2; empty if nothing was measured
    std::vector<report::ParameterRow> truth;        // the same, of the same points; empty without a truth
};

// Levelled, and then, if the evaluation's band has a limit, filtered as well.
std::vector<Figures> figures_of(const Evaluation& evaluation);

// NaN (nothing measured, undefined) becomes null in JSON.
nlohmann::ordered_json json_of(const Figures& figures);

} // namespace vkfv::measurement
