// The run of a sweep: every combination of the values in a configuration's [sweep], as images or as stacks.
#pragma once

#include "configuration/configuration.hpp"
#include "core/messages/progress.hpp"
#include "measurement/stack/stack.hpp"
#include "measurement/sweep/sweep_report.hpp"

#include <filesystem>
#include <functional>
#include <vector>

namespace vkfv::measurement {

struct SweepResult {
    Sweep sweep;
    std::vector<SweepRow> rows;
    std::filesystem::path folder; // holds a folder for each combination
};

// Measures the combinations that the output folder lacks, with a folder for each, and writes the tables, the contact
// sheet and the charts (sweep_report.hpp). after_stack gets each stack when it is measured. Throws InputError before
// the first combination is traced, also where a later one is wrong, and what an image or a stack throws; the same call
// continues.
SweepResult run_sweep(const std::filesystem::path& file, const std::vector<TomlOverride>& overrides, Progress& progress,
                      const std::function<void(const StackResult&)>& after_stack);

} // namespace vkfv::measurement
