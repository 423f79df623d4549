// Every combination of what a configuration's [sweep] varies, as images or as stacks.
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
    std::filesystem::path folder; // that holds a folder for each combination
};

// Measures what the output folder lacks, a folder a combination, and writes the tables, the contact sheet and the
// charts (sweep_report.hpp). after_stack gets each stack when it is measured. InputError, also for whatever is wrong
// with a later combination, before the first is traced; else what an image or a stack throws: the same call continues.
SweepResult run_sweep(const std::filesystem::path& file, const std::vector<TomlOverride>& overrides, Progress& progress,
                      const std::function<void(const StackResult&)>& after_stack);

} // namespace vkfv::measurement
