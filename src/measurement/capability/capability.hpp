// The capability of an instrument: which sinusoids it measures, over their wavelength and amplitude, beside its limits
// in closed form, and where a rough specimen lies among them.
#pragma once

#include "configuration/configuration.hpp"
#include "core/messages/progress.hpp"
#include "measurement/calibration/tested_instrument.hpp"
#include "measurement/capability/limits.hpp"
#include "measurement/capability/nodes.hpp"
#include "measurement/capability/rough_specimen.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vkfv::measurement {

struct CapabilityRequest {
    std::filesystem::path file; // the configuration of a stack, whose specimen is replaced by the sinusoids
    std::vector<TomlOverride> overrides;
    bool small = false;               // TestedField::small
    std::optional<int> wavelengths{}; // at least 2; none: 7, or 3 if small
    std::optional<int> amplitudes{};  // at least 2; none: 6, or 3 if small
    std::string program;              // version of the program, as the map names it
};

struct Capability {
    std::string program;                // version and commit
    std::string title;                  // name of the configuration
    TestedInstrument instrument{};      // as it was tested
    std::vector<std::string> devices{}; // that traced
    LimitingProperties properties{};    // with the noise of a flat
    std::vector<CapabilityNode> nodes{};
    std::optional<RoughSpecimen> specimen{}; // of the configuration, if it has no nominal dimension
};

// The node nearest to the wave, by the ratios of wavelength and amplitude. The map has nodes.
const CapabilityNode& nearest_node(const Capability& capability, const SurfaceWave& wave);

// The greater over the smaller of neighbouring numbers of the map, whose ratios are equal: of its wavelengths or
// amplitudes. 1 for a single one.
double spacing_of_map(const Capability& capability, double SurfaceWave::*of);

struct CapabilityResult {
    nlohmann::ordered_json document; // capability.json
    std::filesystem::path folder;
};

// Measures the stacks that the output folder lacks, each in a folder of its own, and writes capability.json and
// capability.html there. Throws InputError before the first stack is traced, and what a stack throws; the same call
// continues.
CapabilityResult capability(const CapabilityRequest& request, Progress& progress);

// The map as lines of text.
std::string summary(const CapabilityResult& result);

} // namespace vkfv::measurement
