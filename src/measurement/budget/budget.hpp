// The uncertainty budget of a measurement by a virtual instrument: how far its result is from the truth when the
// numbers of the configuration deviate as [uncertainty] says, one at a time (JCGM 100) and all together (JCGM 101). The
// instrument does not know these deviations. So its heights keep their pitch, detector.assumed_pitch_um or else the
// true one of the undeviated configuration.
#pragma once

#include "configuration/configuration.hpp"
#include "core/messages/progress.hpp"
#include "measurement/budget/combined_uncertainty.hpp"
#include "measurement/budget/measurand.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vkfv::measurement {

struct BudgetRequest {
    std::filesystem::path file; // the configuration of a stack with [uncertainty]
    std::vector<TomlOverride> overrides;
    std::string measurand; // as measurand() takes it
    int trials = 0;        // in which all inputs deviate at once
    // Measurements with no input changed, at least 2: they show the noise. As many more, each of a specimen with a
    // texture of its own if it has one that a seed draws, show what texture adds.
    int repeats = 0;
    std::string program; // version of the program, as the budget names it
};

// An input of the budget.
struct BudgetRow {
    UncertainInput input;
    double value = 0;             // of the configuration
    double sensitivity = 0;       // change of the result's error by a unit of the input
    Contribution contribution{};  // in the result's unit
    double sensitivity_noise = 0; // standard deviation of the contribution by the noise of the two measurements
};

struct Budget {
    MeasurandValue nominal; // means over the repetitions; over those with textures of their own where there are any
    std::vector<BudgetRow> rows;
    Contribution noise{};                  // of one measurement
    std::optional<Contribution> texture{}; // none: no seed draws the specimen's texture
    CombinedUncertainty by_parts{};        // JCGM 100
    TrialStatistics by_trials{};           // of the errors in trials
    std::vector<double> errors{};          // of the trials, in their order; NaN: failed
    int failed = 0;                        // trials without a result
    // Standard uncertainty by trials over the combined one: 0.8 to 1.25 where the model is linear.
    double ratio() const { return by_trials.standard_deviation / by_parts.standard_uncertainty; }
    // The larger distance between an end of the trials' interval and that end of nominal.error() +- U (JCGM 101,
    // clause 8.1).
    double interval_difference() const;
};

struct BudgetResult {
    nlohmann::ordered_json document; // budget.json
    std::filesystem::path folder;
};

// Measures the stacks that the output folder lacks, each in a folder of its own, and writes budget.json and budget.html
// there. Throws InputError before the first stack is traced, also for inputs that are no numbers of the configuration
// and for deviations that its keys do not allow; RunError if the measurand is not found; and what a stack throws. The
// same call continues.
BudgetResult budget(const BudgetRequest& request, Progress& progress);

// The budget as lines of text.
std::string summary(const BudgetResult& result);

} // namespace vkfv::measurement
