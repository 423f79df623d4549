// The report that `vkfv check` prints, kept from one run to the next.
#pragma once

#include "configuration/configuration.hpp"
#include "core/messages/warning.hpp"
#include "measurement/scene/verdict.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace vkfv::measurement {

struct InstrumentReport {
    Verdict verdict;
    std::vector<Warning> warnings;
    std::string figures_that_matter, all_figures; // tables for a terminal
    nlohmann::ordered_json json;                  // all figures, verdict and warnings
};

// The report of instrument_figures(). A report of the same configuration by the same program is kept and not computed
// again, as long as no file that was read has changed; the log then gets the messages of the first time again. file:
// the configuration's name in the report. Throws InputError.
InstrumentReport instrument_report(const Configuration& configuration, const std::filesystem::path& file);

} // namespace vkfv::measurement
