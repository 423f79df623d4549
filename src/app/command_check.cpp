#include "app/commands.hpp"

#include "core/units.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace vkfv::app {

namespace {

struct Property {
    const char* name; // as in JSON, with its unit
    double value;
    const char* meaning;
};

std::vector<Property> properties(const Configuration& configuration, const optics::FirstOrder& first_order) {
    std::vector<Property> list = {
        {"efl_objective_mm", first_order.efl_objective, "focal length of the objective"},
        {"efl_tube_lens_mm", first_order.efl_tube_lens, "focal length of the tube lens"},
        {"magnification", first_order.magnification, "paraxial, at the detector; negative: inverted"},
        {"numerical_aperture", first_order.numerical_aperture,
         "object side, on the axis, through all apertures"},
        {"working_distance_mm", first_order.working_distance, "paraxial object plane to the front vertex"},
        {"depth_of_field_um", first_order.depth_of_field * um_per_mm, "lambda / NA^2"},
        {"pixel_pitch_um", first_order.pixel_pitch * um_per_mm, "in the object plane"},
        {"field_of_view_um", first_order.pixel_pitch * configuration.instrument.detector_pixels * um_per_mm,
         "side of the square that the detector sees"},
        {"best_focus_offset_um", first_order.best_focus_offset * um_per_mm,
         "on-axis RMS best focus above the paraxial plane; z = 0 of the scan"},
        {"field_curvature_um", first_order.field_curvature * um_per_mm,
         "best focus at the field's edge above that on the axis"},
        {"field_edge_um", first_order.field_edge * um_per_mm, "the height in the field it belongs to"},
        {"pupil_radius_in_source_mm", first_order.pupil_radius_in_source,
         "radius of the source that fills the objective's pupil"},
        {"source_radius_mm", configuration.instrument.source_radius, "as configured"},
        {"illumination_to_objective_mm", first_order.illumination_to_objective,
         "last vertex of the illumination to the objective's back"},
    };
    return list;
}

constexpr int most_relief_points = 128; // a side; a look at the specimen, in a moment for any detector

// Lowest and highest point of the specimen in the field of view, and the share of the field that it fills.
struct Relief {
    double lowest = INFINITY;
    double highest = -INFINITY;
    double seen_share = 0;
};

Relief relief_of(const specimen::Specimen& specimen, double field, int pixels) {
    const int points = std::min(pixels, most_relief_points);
    const double pitch = field / points;
    const double first = -0.5 * (points - 1) * pitch;
    const auto truth = specimen::truth(specimen, points, points, first, first, pitch, pitch);
    Relief relief;
    std::size_t seen = 0;
    for (const double height : truth.height.values) {
        if (std::isfinite(height)) {
            relief.lowest = std::min(relief.lowest, height);
            relief.highest = std::max(relief.highest, height);
            ++seen;
        }
    }
    relief.seen_share = static_cast<double>(seen) / static_cast<double>(truth.height.values.size());
    return relief;
}

} // namespace

void run_check(const CommandOptions& options) {
    const auto configuration = load_configuration(options.file, options.overrides, Needs::instrument);
    const auto instrument = assemble_instrument(configuration);
    std::vector<std::string> warnings = instrument.warnings;
    nlohmann::ordered_json report;
    report["configuration"] = options.file.string();
    std::string text = fmt::format("{}: valid\n", options.file.string());
    for (const auto& [name, value, meaning] : properties(configuration, instrument.first_order)) {
        report[name] = value;
        text += fmt::format("  {:<30} {:>14.6g}  {}\n", name, value, meaning);
    }

    std::vector<double> positions;
    if (configuration.scan) {
        positions = configuration.scan->positions();
        report["images"] = positions.size();
        report["rays_per_image"] = configuration.trace.rays;
        text += fmt::format("  {:<30} {:>14}  z from {:g} to {:g} um, {:.3g} rays each\n", "images",
                            positions.size(), positions.front() * um_per_mm, positions.back() * um_per_mm,
                            static_cast<double>(configuration.trace.rays));
    }
    if (configuration.specimen) {
        const auto specimen = specimen::make(*configuration.specimen);
        const int pixels = configuration.instrument.detector_pixels;
        const auto relief = relief_of(specimen, instrument.first_order.pixel_pitch * pixels, pixels);
        report["specimen_seen_share"] = relief.seen_share;
        if (relief.seen_share > 0) {
            report["specimen_lowest_um"] = relief.lowest * um_per_mm;
            report["specimen_highest_um"] = relief.highest * um_per_mm;
            text += fmt::format("  {:<30} {:>14.6g}  highest {:g} um, on {:.1f} % of the field\n",
                                "specimen_lowest_um", relief.lowest * um_per_mm, relief.highest * um_per_mm,
                                100 * relief.seen_share);
        } else {
            warnings.push_back("the detector does not see the specimen");
        }
        if (!positions.empty() && relief.seen_share > 0 &&
            (relief.lowest < positions.front() || relief.highest > positions.back())) {
            warnings.push_back(
                fmt::format("the specimen reaches from {:.3g} to {:.3g} um, beyond the scan: what lies "
                            "outside will not be measured",
                            relief.lowest * um_per_mm, relief.highest * um_per_mm));
        }
    }
    report["warnings"] = warnings;
    for (const auto& warning : warnings) {
        text += "  warning: " + warning + "\n";
    }
    fmt::print("{}", options.json ? report.dump(2) + "\n" : text);
}

} // namespace vkfv::app
