// The text and JSON of one surface, with its parameters and those of a profile.
#pragma once

#include "measurement/surface/standard.hpp"
#include "report/parameter_table.hpp"
#include "surface/height_map.hpp"
#include "surface/roughness_profile.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vkfv::measurement {

// Tells whether any point of the map was measured.
bool any_height(const surface::HeightMap& map);

// The places on the material ratio curves, of the surface and of its profile, for which values were asked.
struct AskedRatios {
    std::optional<double> height; // mm over the mean height
    std::optional<double> ratio;  // 0 to 1
};

struct SurfaceFigures {
    int columns = 0;
    int rows = 0;
    double x0 = 0, y0 = 0; // mm, of the first point
    double pitch_x = 0, pitch_y = 0;
    surface::Band band;                           // treatment of the surface
    std::ptrdiff_t not_measured = 0;              // points without a height, also those beyond a sphere
    std::vector<report::ParameterRow> parameters; // ISO 25178-2
    surface::ProfileLine line;
    surface::RoughnessProfile profile;
    std::vector<report::ParameterRow> asked{};   // Smr, Rmr, Smc and Rmc, if asked for
    std::vector<StandardDimension> dimensions{}; // of the sought feature
    std::vector<std::string> warnings{};         // about the file
};

// The figures of a surface that was treated by `band`, and of the profile along the line.
SurfaceFigures surface_figures(const surface::HeightMap& map, const surface::ProfileLine& line,
                               const surface::ProfileSetting& setting, const surface::Band& band);

// The rows that were asked for: of the treated surface, and of the profile after its filters.
std::vector<report::ParameterRow> asked_rows(const surface::HeightMap& map, const surface::RoughnessProfile& profile,
                                             const AskedRatios& asked);

// The filters of a profile as a text: "section length 20 um, L-filter 20 um (Gaussian, a fifth of the profile)".
std::string profile_filter_text(const surface::RoughnessProfile& profile);
// The filters of a profile as members: section_length_um, s_filter_um, l_filter_um and setting_class, each null if
// there is none.
nlohmann::ordered_json profile_filter_json(const surface::RoughnessProfile& profile);

// file: the file that the surface was read from. NaN (undefined) becomes null.
nlohmann::ordered_json surface_json(const SurfaceFigures& figures, const std::filesystem::path& file);

// Tables for a terminal.
std::string surface_text(const SurfaceFigures& figures);

} // namespace vkfv::measurement
