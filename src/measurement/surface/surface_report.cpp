#include "measurement/surface/surface_report.hpp"

#include "core/mathematics/units.hpp"
#include "surface/areal_parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vkfv::measurement {

bool any_height(const surface::HeightMap& map) {
    return std::ranges::any_of(map.height.values, [](double z) { return std::isfinite(z); });
}

SurfaceFigures surface_figures(const surface::HeightMap& map, const surface::ProfileLine& line,
                               const surface::ProfileSetting& setting, const surface::Band& band) {
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
            .profile = surface::roughness_profile(map, line, setting)};
}

std::vector<report::ParameterRow> asked_rows(const surface::HeightMap& map, const surface::RoughnessProfile& profile,
                                             const AskedRatios& asked) {
    std::vector<report::ParameterRow> rows;
    const auto add = [&](const surface::HeightMap& heights, const char* ratio, const char* height) {
        const surface::MaterialRatioCurve curve(heights);
        const double mean = surface::height_parameters(heights).mean;
        if (asked.height) {
            rows.push_back({fmt::format("{}({:g} um)", ratio, *asked.height * um_per_mm), "percent",
                            100 * curve.ratio(mean + *asked.height)});
        }
        if (asked.ratio) {
            rows.push_back({fmt::format("{}({:g} %)", height, *asked.ratio * 100), "um",
                            (curve.height(*asked.ratio) - mean) * um_per_mm});
        }
    };
    if (asked.height || asked.ratio) {
        add(map, "Smr", "Smc");
        add(surface::map_of(profile.roughness), "Rmr", "Rmc");
    }
    return rows;
}

std::string profile_filter_text(const surface::RoughnessProfile& profile) {
    const auto um = [](double length) { return fmt::format("{:.4g} um", length * um_per_mm); };
    std::string text = "section length " + um(profile.section_length);
    if (profile.s_filter > 0) {
        text += ", S-filter " + um(profile.s_filter);
    }
    if (profile.l_filter <= 0) {
        return text + ", no L-filter of its own";
    }
    text += ", L-filter " + um(profile.l_filter) + " (Gaussian";
    if (profile.setting_class != nullptr) {
        text += fmt::format(", {} of ISO 21920-3", profile.setting_class->name);
    } else if (profile.l_filter == profile.section_length) {
        text += ", a fifth of the profile";
    }
    return text + ")";
}

nlohmann::ordered_json profile_filter_json(const surface::RoughnessProfile& profile) {
    nlohmann::ordered_json json = {{"section_length_um", profile.section_length * um_per_mm},
                                   {"s_filter_um", profile.s_filter * um_per_mm},
                                   {"l_filter_um", profile.l_filter * um_per_mm},
                                   {"setting_class", nullptr}};
    if (profile.setting_class != nullptr) {
        json["setting_class"] = std::string(profile.setting_class->name);
    }
    return json;
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
    report["std_direction"] = report::std_direction;
    const auto& line = figures.line;
    report["profile"] = {{"start_um", {line.x_start * um_per_mm, line.y_start * um_per_mm}},
                         {"end_um", {line.x_end * um_per_mm, line.y_end * um_per_mm}}};
    report["profile"].update(profile_filter_json(figures.profile));
    report["profile"].update(report::json_of(report::parameter_rows(figures.profile.parameters)));
    if (!figures.asked.empty()) {
        report["material_ratio"] = report::json_of(figures.asked);
    }
    add_dimensions(report, figures.dimensions);
    report["warnings"] = figures.warnings;
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
            text += fmt::format("{:<8} {:<12} {:>12}\n", row.name, row.unit, report::number_text(row.value));
        }
    };
    text += "\nISO 25178-2\n";
    table(figures.parameters);
    text += std::string(report::std_direction) + ".\n";
    if (const auto loss = report::slope_loss_text(figures.parameters); !loss.empty()) {
        text += loss + "\n";
    }
    const auto& line = figures.line;
    text += fmt::format("\nISO 21920-2, profile from ({:.6g}, {:.6g}) um to ({:.6g}, {:.6g}) um, {}\n",
                        line.x_start * um_per_mm, line.y_start * um_per_mm, line.x_end * um_per_mm,
                        line.y_end * um_per_mm, profile_filter_text(figures.profile));
    table(report::parameter_rows(figures.profile.parameters));
    if (!figures.asked.empty()) {
        text += "\nMaterial ratio\n";
        for (const auto& row : figures.asked) {
            text += fmt::format("{:<18} {:>12} {}\n", row.name, report::number_text(row.value), row.unit);
        }
    }
    return figures.dimensions.empty() ? text : text + "\nDimensions\n" + dimensions_text(figures.dimensions);
}

} // namespace vkfv::measurement
