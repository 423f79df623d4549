// The instrument of a configuration without its specimen, as virtual standards are laid under it.
#pragma once

#include "configuration/configuration.hpp"
#include "measurement/calibration/characteristic.hpp"
#include "measurement/evaluation/evaluation.hpp"

#include <filesystem>
#include <string>

namespace vkfv::measurement {

struct TestedInstrument {
    std::string toml; // canonical, without [specimen]
    Conditions conditions{};
    double numerical_aperture = 0; // object side, n sin(theta)
    double object_index = 1;       // of the medium over the specimen (n)
    std::string identity_digest{}; // SHA-256 of all that images depend on, but for the specimen
    std::string layout{};          // SVG of the instrument, to scale
};

// The part of the detector and of the scan that is looked at. The small ones are the middle 160 or 320 pixels, and at
// most 31 images: of the whole scan if half a standard deviation of a focus curve suffices as their distance, else of
// its middle. Settings in steps of the scan keep their lengths.
enum class TestedField { whole, small, small_lateral };

// The instrument of a configuration with [scan]. Throws InputError.
TestedInstrument tested_instrument(const Configuration& base, TestedField field);

// The configuration of a stack of the trial's standard. file: of the instrument, from which relative paths start.
// folder: that of the stack. Throws InputError.
Configuration with_standard(const TestedInstrument& instrument, const std::filesystem::path& file, const Trial& trial,
                            const std::filesystem::path& folder);

// The heights, uncertainties and dimensions that the evaluation of a stack of a standard holds, under the name of its
// trial. Throws std::bad_optional_access if the evaluation has no truth.
TrialResult result_of(const std::string& name, const Evaluation& evaluation);

} // namespace vkfv::measurement
