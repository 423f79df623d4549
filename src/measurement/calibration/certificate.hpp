// The certificate of a virtual calibration, as JSON and as a page.
#pragma once

#include "configuration/configuration.hpp"
#include "measurement/calibration/characteristic.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <string>
#include <vector>

namespace vkfv::measurement {

// A characteristic with its figures, and the stacks that they come from.
struct CertificateEntry {
    const Characteristic* characteristic = nullptr;
    Findings findings{};
    std::vector<std::string> trials{}; // folders of the stacks, relative to the certificate
};

struct Certificate {
    std::string program;                // version and commit
    std::string title;                  // name of the configuration
    std::string identity_digest;        // digest of all that images depend on, but for the specimen
    std::vector<std::string> devices{}; // that traced
    Conditions conditions;
    std::string layout; // SVG of the instrument
    std::vector<CertificateEntry> entries{};
    std::string configuration; // TOML of the instrument as it was calibrated
};

// Says on every page what the certificate is not.
inline constexpr const char* not_traceable = "Of a simulated instrument; not traceable.";
// Says what images of smooth standards by waves leave out.
inline constexpr const char* smooth_standards =
    "The standards are smooth and printed: waves filter their intensity, so that speckle, phase contrast of relief and "
    "diffraction at edges are not modelled.";

// The part of the scan that a measurement covered, in words: "33 µm of the scan, in steps of 1.1 µm".
std::string scan_text(const Conditions& conditions);

// A property of the instrument that the standards were chosen by.
struct ConditionRow {
    const char* key;   // in certificate.json, with its unit
    const char* words; // without its unit
    const char* unit;  // "um" or none
    double value;
};
std::array<ConditionRow, 9> condition_rows(const Conditions& conditions);

// The conditions of the measurements as the rows of a table, with its head.
std::vector<std::vector<std::string>> conditions_table(const Conditions& conditions);

nlohmann::ordered_json certificate_json(const Certificate& certificate);
std::string certificate_page(const Certificate& certificate);

} // namespace vkfv::measurement
