// What `vkfv check` prints, kept from one run to the next.
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
    std::string figures_that_matter, all_figures; // tables for a person
    nlohmann::ordered_json json;                  // all of it
};

// Of instrument_figures(). The same configuration, by the same program, is not computed again as long as every file
// that was read is as it was; messages to the log come as they came the first time. file: as the report names the
// configuration. Throws InputError.
InstrumentReport instrument_report(const Configuration& configuration, const std::filesystem::path& file);

} // namespace vkfv::measurement
