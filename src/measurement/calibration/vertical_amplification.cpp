// Amplification coefficient alpha_z and linearity deviation l_z: ISO 25178-600, on grooves of several depths.
#include "core/mathematics/units.hpp"
#include "measurement/calibration/standards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vkfv::measurement {

namespace {
namespace of_depths { // files of a unity build share the unnamed namespace

constexpr int depths = 7;
constexpr double shallowest = 0.05, deepest = 0.9; // of the usable range, or shallower alike where the field is narrow

// The deepest groove. The others are as wide.
Groove deepest_groove(const Conditions& conditions) {
    constexpr double widths_a_field = 2.6; // levels beside the groove need a width on either side
    return groove_of(conditions, deepest * conditions.usable_range(), 1 / widths_a_field);
}

std::vector<Trial> trials(const Conditions& conditions, std::vector<std::string>& remarks) {
    constexpr double least_windows = 3;
    const double usable = conditions.usable_range();
    if (usable < 4 * conditions.step) {
        remarks.push_back(
            "The scan is shorter than four standard deviations of a focus curve and four steps: no groove "
            "fits into it.");
        return {};
    }
    const Groove largest = deepest_groove(conditions);
    if (largest.width < least_windows * conditions.window || largest.depth < conditions.step) {
        remarks.push_back("The field is narrower than eight focus windows, or than the light cone of a groove of one "
                          "step: no groove fits into it.");
        return {};
    }
    remark_shallower(conditions, largest, deepest * usable, remarks);
    std::vector<Trial> list;
    for (int k = 0; k < depths; ++k) {
        const double share = (shallowest + (deepest - shallowest) * k / (depths - 1)) / deepest;
        const Groove groove{.width = largest.width, .depth = largest.depth * share};
        const double room = 0.5 * (usable - groove.depth);
        const std::vector<double> places = conditions.small ? std::vector{0.0} : std::vector{-room, 0.0, room};
        for (std::size_t place = 0; place < places.size(); ++place) {
            const auto print = static_cast<std::uint32_t>(list.size() + 1);
            list.push_back({.name = fmt::format("depth_{}_place_{}", k, place),
                            .specimen = groove_standard(conditions, groove, print) +
                                        placed_at(0, 0, conditions.middle() + 0.5 * groove.depth + places[place]),
                            .overrides = repetition(conditions, static_cast<int>(list.size()))});
        }
    }
    return list;
}

Findings evaluate(const Conditions& conditions, std::span<const TrialResult> results) {
    Findings findings;
    CertificateTable table{.caption = "Depths of the grooves",
                           .columns = {"true depth / µm", "measured / µm", "u / µm", "distance from the line / nm"},
                           .rows = {}};
    std::vector<double> truths, measured, uncertainties;
    for (const auto& result : results) {
        if (const auto* depth = dimension(result, "groove depth")) {
            truths.push_back(depth->truth);
            measured.push_back(depth->measured.value);
            uncertainties.push_back(uncertainty_of(*depth));
        }
    }
    const Line line = line_through(truths, measured);
    constexpr double nm = 1e6;
    report::Curve off{.name = "", .points = {}, .spreads = {}, .line = false, .markers = true};
    double squares = 0;
    for (std::size_t k = 0; k < truths.size(); ++k) {
        const double distance = (measured[k] - line.offset - line.slope * truths[k]) * nm;
        table.rows.push_back({truths[k] * um_per_mm, measured[k] * um_per_mm, uncertainties[k] * um_per_mm, distance});
        off.points.emplace_back(truths[k] * um_per_mm, distance);
        squares += uncertainties[k] * uncertainties[k];
    }
    const double of_a_depth = std::sqrt(squares / static_cast<double>(truths.size()));
    findings.figures = {{.key = "alpha_z",
                         .title = "alpha_z",
                         .unit = "",
                         .value = line.slope,
                         .standard_uncertainty = line.slope_uncertainty,
                         .degrees_of_freedom = line.degrees_of_freedom},
                        {.key = "l_z_nm",
                         .title = "l_z, largest distance from the line",
                         .unit = "nm",
                         .value = line.farthest * nm,
                         .standard_uncertainty = of_a_depth * nm}};
    findings.charts.push_back({.title = "Distance of the depths from the line",
                               .x_label = "true depth / um",
                               .y_label = "distance / nm",
                               .curves = {off}});
    findings.tables.push_back(std::move(table));
    if (truths.size() < results.size()) {
        findings.remarks.push_back(fmt::format("{} of {} grooves were not measured, and do not count.",
                                               results.size() - truths.size(), results.size()));
    }
    findings.remarks.push_back(
        fmt::format("The grooves are {:.3g} windows wide.", deepest_groove(conditions).width / conditions.window));
    if (conditions.small) {
        findings.remarks.push_back("Each groove stands in the middle of the scan alone.");
    }
    return findings;
}

} // namespace of_depths
} // namespace

Characteristic vertical_amplification() {
    return {.name = "alpha_z",
            .title = "Amplification and linearity in z",
            .standard = "Grooves (type PGR) of seven depths, from 5 to 90 % of the scan less four standard deviations "
                        "of a focus curve, at three heights in the scan. Each is wide enough for the middle third of "
                        "its bottom to receive the whole light cone; where the field is too narrow for that, all are "
                        "shallower.",
            .procedure = "Depths by ISO 5436-1. alpha_z is the slope of the least-squares line of measured over true "
                         "depths, l_z the largest distance of a depth from the line. The line has an offset of its "
                         "own, which takes what all depths have in common, such as the flatness deviation. The "
                         "uncertainty of alpha_z is that of the scatter about the line, that of l_z the stated "
                         "uncertainty of a depth.",
            .equation = R"(d_i = \alpha_z d_{i, \mathrm{true}} + b + e_i, \quad \sum_i e_i^2 = \min, )"
                        R"(\quad l_z = \max_i |e_i|)",
            .trials = of_depths::trials,
            .evaluate = of_depths::evaluate};
}

} // namespace vkfv::measurement
