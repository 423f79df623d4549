// The figures of an evaluation: deviation and ISO 25178-2 parameters, by the treatment of the surface.
#pragma once

#include "measurement/evaluation/evaluation.hpp"
#include "report/parameter_table.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <vector>

namespace vkfv::measurement {

struct Figures {
    topography::Band band; // treatment of the measured heights and of the truth
    double measured_share = 0;
    std::optional<topography::Deviation> deviation; // none without a truth
    std::vector<report::ParameterRow> measured;     // ISO 25178-2; empty if nothing was measured
    std::vector<report::ParameterRow> truth;        // of the true heights at the same points; empty without a truth
};

// The figures of the levelled surface and, if the evaluation's band has a limit, of the filtered one behind it.
std::vector<Figures> figures_of(const Evaluation& evaluation);

// NaN (nothing measured, undefined) becomes null.
nlohmann::ordered_json json_of(const Figures& figures);

} // namespace vkfv::measurement
