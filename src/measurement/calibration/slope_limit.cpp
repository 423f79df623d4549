// The steepest slope that is measured, and how much of a slope is measured wrongly without a word.
#include "core/mathematics/units.hpp"
#include "measurement/calibration/standards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace vkfv::measurement {

namespace {
namespace of_slopes { // files of a unity build share the unnamed namespace

constexpr double wanted_share = 0.95, most_wrong = 0.01;

std::vector<double> tilts_of(const Conditions& conditions) {
    std::vector<double> tilts;
    for (double tilt = 0; tilt <= 80; tilt += conditions.small ? 20 : 5) {
        tilts.push_back(tilt);
    }
    return tilts;
}

std::vector<Trial> trials(const Conditions& conditions, std::vector<std::string>& remarks) {
    if (conditions.usable_range() < 4 * conditions.step) {
        remarks.push_back("The scan is shorter than four standard deviations of a focus curve and four steps.");
        return {};
    }
    std::vector<Trial> list;
    for (const double tilt : tilts_of(conditions)) {
        list.push_back({.name = fmt::format("tilt_{:02.0f}", tilt),
                        .specimen = standard_of(conditions, "plane", fmt::format("tilt_x_deg = {:.1f}\n", tilt), 0) +
                                    printed(conditions, usual_contrast, 1),
                        .overrides = {}});
    }
    return list;
}

Findings evaluate(const Conditions& conditions, std::span<const TrialResult> results) {
    const auto tilts = tilts_of(conditions);
    Findings findings;
    CertificateTable table{.caption = "Measured shares over the slope",
                           .columns = {"slope / °", "points", "right / %", "wrong / %", "RMS deviation / nm"},
                           .rows = {}};
    report::Curve right{.name = "measured and right", .points = {}, .spreads = {}, .markers = true};
    report::Curve wrong{.name = "measured and wrong", .points = {}, .spreads = {}, .markers = true};
    double limit = surface::undefined, most = 0;
    bool so_far = true;
    const double offset = common_offset(results.front());
    for (std::size_t k = 0; k < tilts.size(); ++k) {
        constexpr double nm = 1e6, percent = 100;
        const PointShares shares = point_shares(conditions, results[k], offset);
        so_far = so_far && shares.right >= wanted_share;
        limit = so_far ? tilts[k] : limit;
        most = std::isfinite(shares.wrong) ? std::max(most, shares.wrong) : most;
        table.rows.push_back(
            {tilts[k], shares.points, percent * shares.right, percent * shares.wrong, shares.deviation * nm});
        right.points.emplace_back(tilts[k], percent * shares.right);
        wrong.points.emplace_back(tilts[k], percent * shares.wrong);
    }
    findings.figures = {{.key = "slope_limit_deg",
                         .title = "steepest slope with 95 % of its points measured and right",
                         .unit = "deg",
                         .value = limit,
                         .standard_uncertainty = (tilts[1] - tilts[0]) / std::sqrt(12.0)},
                        {.key = "most_wrong_percent",
                         .title = "largest share of a slope that is wrong by more than 3 u",
                         .unit = "percent",
                         .value = 100 * most}};
    findings.charts.push_back({.title = "Measured shares over the slope",
                               .x_label = "slope / deg",
                               .y_label = "points / %",
                               .curves = {right, wrong}});
    findings.tables.push_back(std::move(table));
    if (!std::isfinite(limit)) {
        findings.remarks.push_back("Not even a level plane has 95 % of its points measured and right.");
    }
    if (most > most_wrong) {
        findings.remarks.push_back(
            "More than 1 % of the points of some slope are wrong by more than three stated uncertainties.");
    }
    return findings;
}

} // namespace of_slopes
} // namespace

Characteristic slope_limit() {
    return {.name = "slope",
            .title = "Slope limit",
            .standard = "Planes with a printed texture, tilted by 0 to 80 degrees.",
            .procedure =
                "Of the points within the scan less two standard deviations of a focus curve at either end, "
                "those within three standard uncertainties of the truth are right, the median deviation of the level "
                "plane taken off. The limit is the steepest "
                "slope up to which 95 % are measured and right; its uncertainty is that of the steps between "
                "the slopes. The print is laid on along the axis, so that it is stretched along a slope.",
            .equation = R"(P\left(|z - z_{\mathrm{true}} - c| \le 3 u(z)\right) \ge 0.95)",
            .trials = of_slopes::trials,
            .evaluate = of_slopes::evaluate};
}

} // namespace vkfv::measurement
