// Tables of the parameters of surfaces and profiles, and of the preparation of the surface, for reports.
#pragma once

#include "surface/areal_parameters.hpp"
#include "surface/band.hpp"
#include "surface/profile.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace vkfv::report {

struct ParameterRow {
    std::string name; // "Sa"
    std::string unit; // unit of `value`: "um", "um3_per_um2", "deg", "percent", "per_mm2", "per_mm" or none
    double value = 0; // NaN: undefined

    std::string key() const; // "Sa_um"
};

// The areal parameters of ISO 25178-2, in its order.
std::vector<ParameterRow> parameter_rows(const surface::ArealParameters& parameters);
// The profile parameters of ISO 21920-2.
std::vector<ParameterRow> parameter_rows(const surface::ProfileParameters& parameters);

// A row's value under its key; NaN becomes null.
nlohmann::ordered_json json_of(const std::vector<ParameterRow>& rows);

// Says what Std is the direction of, and from where it counts.
inline constexpr const char* std_direction =
    "Std is the direction of the lay, not of the wave across it: from the x axis "
    "(0) towards the y axis (positive)";

// Says by how much sampling lowers Sdq and Sdr, where that is 1 % or more of Sdq; empty otherwise.
std::string slope_loss_text(const std::vector<ParameterRow>& rows);

// A number of six digits; "-" for NaN.
std::string number_text(double value);

nlohmann::ordered_json treatment_json(const surface::Band& band);
// The band in words: "form plane, S-filter 5 um (Gaussian)".
std::string treatment_text(const surface::Band& band);

} // namespace vkfv::report
