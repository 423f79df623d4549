// The text and JSON of one surface: its parameters, and those of a profile.
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

// Whether any point was measured.
bool any_height(const surface::HeightMap& map);

// Places on the material ratio curves, of the surface and of its profile, that were asked for.
struct AskedRatios {
    std::optional<double> height; // mm over the mean height
    std::optional<double> ratio;  // 0 to 1
};

struct SurfaceFigures {
    int columns = 0;
    int rows = 0;
    double x0 = 0, y0 = 0; // mm, of the first point
    double pitch_x = 0, pitch_y = 0;
    surface::Band band;                           // what was done to the surface before
    std::ptrdiff_t not_measured = 0;              // points; beyond a sphere too
    std::vector<report::ParameterRow> parameters; // ISO 25178-2
    surface::ProfileLine line;
    surface::RoughnessProfile profile;
    std::vector<report::ParameterRow> asked{};   // Smr, Rmr, Smc and Rmc where asked for
    std::vector<StandardDimension> dimensions{}; // of what was sought
    std::vector<std::string> warnings{};         // of the file
};

// Of a surface that was treated by `band`, and of the profile along the line.
SurfaceFigures surface_figures(const surface::HeightMap& map, const surface::ProfileLine& line,
                               const surface::ProfileSetting& setting, const surface::Band& band);

// The rows of what was asked for: of the treated surface, and of the profile after its filters.
std::vector<report::ParameterRow> asked_rows(const surface::HeightMap& map, const surface::RoughnessProfile& profile,
                                             const AskedRatios& asked);

// "section length 20 um, L-filter 20 um (Gaussian, a fifth of the profile)"
std::string profile_filter_text(const surface::RoughnessProfile& profile);
// The same as members: section_length_um, s_filter_um, l_filter_um and setting_class, null without one.
nlohmann::ordered_json profile_filter_json(const surface::RoughnessProfile& profile);

// file: where the surface was read. NaN (undefined) becomes null.
nlohmann::ordered_json surface_json(const SurfaceFigures& figures, const std::filesystem::path& file);

// Tables for a person.
std::string surface_text(const SurfaceFigures& figures);

} // namespace vkfv::measurement
