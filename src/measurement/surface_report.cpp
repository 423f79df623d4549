#include "measurement/surface_report.hpp"

#include "core/units.hpp"
#include "surface/areal_parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vkfv::measurement {

bool any_height(const surface::HeightMap& map) {
    return std::ranges::any_of(map.height.values, [](double z) { return std::isfinite(z); });
}

SurfaceFigures surface_figures(const surface::HeightMap& map, const surface::ProfileLine& line,
                               const surface::Band& band) {
    const auto profile = surface::roughness_profile(map, line);
    return {.columns = map.columns(),
            .rows = map.rows(),
            .x0 = map.x0,
            .y0 = map.y0,
            .pitch_x = map.pitch_x,
            .pitch_y = map.pitch_y,
            .band = band,
            .not_measured = std::ranges::count_if(map.height.values, [](double z) { return !std::isfinite(z); }),
            .parameters = report::parameter_rows(surface::areal_parameters(map)),
            .line = line,
            .section_length = profile.section_length,
            .profile = report::parameter_rows(profile.parameters)};
}

nlohmann::ordered_json surface_json(const SurfaceFigures& figures, const std::filesystem::path& file) {
    nlohmann::ordered_json report;
    report["file"] = file.string();
    report["columns"] = figures.columns;
    report["rows"] = figures.rows;
    report["pitch_um"] = {figures.pitch_x * um_per_mm, figures.pitch_y * um_per_mm};
    report["first_point_um"] = {figures.x0 * um_per_mm, figures.y0 * um_per_mm};
    report["not_measured_points"] = figures.not_measured;
    report["treatment"] = report::treatment_json(figures.band);
    report["parameters"] = report::json_of(figures.parameters);
    const auto& line = figures.line;
    report["profile"] = {{"start_um", {line.x_start * um_per_mm, line.y_start * um_per_mm}},
                         {"end_um", {line.x_end * um_per_mm, line.y_end * um_per_mm}},
                         {"section_length_um", figures.section_length * um_per_mm}};
    report["profile"].update(report::json_of(figures.profile));
    report["evaluated_by"] = fmt::format("vkfv {}", VKFV_VERSION);
    return report;
}

std::string surface_text(const SurfaceFigures& figures) {
    const auto size = [](int points, double pitch) { return points * pitch * um_per_mm; };
    std::string text = fmt::format("{:<14} {} x {} points, {:.6g} x {:.6g} um\n", "size", figures.columns, figures.rows,
                                   size(figures.columns, figures.pitch_x), size(figures.rows, figures.pitch_y));
    text += fmt::format("{:<14} {:.6g} x {:.6g} um, from x = {:.6g} um, y = {:.6g} um\n", "pitch",
                        figures.pitch_x * um_per_mm, figures.pitch_y * um_per_mm, figures.x0 * um_per_mm,
                        figures.y0 * um_per_mm);
    text += fmt::format("{:<14} {} points ({:.3g} %)\n", "not measured", figures.not_measured,
                        100.0 * static_cast<double>(figures.not_measured) /
                            (static_cast<double>(figures.columns) * figures.rows));
    text += fmt::format("{:<14} {}\n", "treatment", report::treatment_text(figures.band));
    const auto table = [&text](const std::vector<report::ParameterRow>& rows) {
        for (const auto& row : rows) {
            text += fmt::format("{:<5} {:<12} {:>12}\n", row.name, row.unit, report::number_text(row.value));
        }
    };
    text += "\nISO 25178-2\n";
    table(figures.parameters);
    const auto& line = figures.line;
    text += fmt::format(
        "\nISO 21920-2, profile from ({:.6g}, {:.6g}) um to ({:.6g}, {:.6g}) um, section length {:.4g} um\n",
        line.x_start * um_per_mm, line.y_start * um_per_mm, line.x_end * um_per_mm, line.y_end * um_per_mm,
        figures.section_length * um_per_mm);
    table(figures.profile);
    return text;
}

} // namespace vkfv::measurement
