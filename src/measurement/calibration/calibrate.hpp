// The virtual calibration of an instrument: its metrological characteristics, each found on virtual standards.
#pragma once

#include "configuration/configuration.hpp"
#include "core/messages/progress.hpp"
#include "measurement/calibration/characteristic.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace vkfv::measurement {

struct CalibrationRequest {
    std::filesystem::path file; // the configuration of a stack, whose specimen is replaced by the standards
    std::vector<TomlOverride> overrides;
    std::vector<std::string> only; // names of characteristics; empty: all
    bool small = false;            // a part of the field and of the scan, fewer repetitions
    std::string program;           // version of the program, as the certificate names it
};

struct CalibrationResult {
    nlohmann::ordered_json certificate;
    std::filesystem::path folder;
};

// Measures the standards that the output folder lacks, each in a folder of its own, and writes certificate.json,
// certificate.xml and certificate.html there. Throws InputError before the first standard is traced, and what a stack
// throws; the same call continues.
CalibrationResult calibrate(const CalibrationRequest& request, Progress& progress);

// The figures as lines of text.
std::string summary(const CalibrationResult& result);

} // namespace vkfv::measurement
