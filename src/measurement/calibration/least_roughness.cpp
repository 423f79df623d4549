// The least roughness whose Sq is measured to 10 %.
#include "core/mathematics/units.hpp"
#include "measurement/calibration/standards.hpp"
#include "surface/filter.hpp"
#include "surface/height_parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vkfv::measurement {

namespace {
namespace of_roughness { // files of a unity build share the unnamed namespace

constexpr double tolerance = 0.1;

std::vector<double> roughnesses_of(const Conditions& conditions) {
    return conditions.small ? std::vector{1e-3, 1e-4} : std::vector{1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5}; // Sq, mm
}

std::vector<Trial> trials(const Conditions& conditions, std::vector<std::string>& remarks) {
    constexpr double roll_off_windows = 12, shortest_windows = 5, heights = 8; // of Sq, that the scan must hold
    if (conditions.longer_field() < 2 * roll_off_windows * conditions.window) {
        remarks.push_back("The field is narrower than 24 focus windows: it holds too few waves of a roughness that the "
                          "window resolves.");
        return {};
    }
    std::vector<Trial> list;
    for (const double sq : roughnesses_of(conditions)) {
        if (heights * sq > conditions.usable_range()) {
            remarks.push_back(fmt::format("The scan does not hold a roughness of Sq {} µm.", um(sq)));
            continue;
        }
        const std::string square = standard_of(conditions, "air", "", conditions.pitch);
        // The kind "air" has no key size_mm: its size is that of its one tile.
        const auto at = square.find("size_mm");
        list.push_back({.name = fmt::format("sq_{}_um", um(sq)),
                        .specimen = square.substr(0, at) + "tiles = 1\ntile_" + square.substr(at) +
                                    fmt::format("sq_um = {}\nroll_off_wavelength_um = {}\nshortest_wavelength_um = {}\n"
                                                "hurst_exponent = 0.8\n",
                                                um(sq), um(roll_off_windows * conditions.window),
                                                um(shortest_windows * conditions.window)) +
                                    printed(conditions, usual_contrast, 1) + placed_at(0, 0, conditions.middle()),
                        .overrides = {}});
    }
    return list;
}

double sq_of(const surface::HeightMap& map, double s_filter) {
    return surface::height_parameters(
               surface::gaussian_low_pass(surface::remove_plane(map, surface::least_squares_plane(map)), s_filter))
        .sq;
}

Findings evaluate(const Conditions& conditions, std::span<const TrialResult> results) {
    Findings findings;
    CertificateTable table{.caption = "Roughness, both surfaces S-filtered",
                           .columns = {"true Sq / nm", "measured Sq / nm", "ratio", "measured / %"},
                           .rows = {}};
    report::Curve ratio{.name = "", .points = {}, .spreads = {}, .markers = true};
    constexpr double nm = 1e6;
    for (const auto& result : results) {
        surface::HeightMap truth = result.truth;
        for (std::size_t k = 0; k < truth.height.values.size(); ++k) {
            truth.height.values[k] += 0 * result.heights.height.values[k]; // NaN where nothing was measured
        }
        const double known = sq_of(truth, conditions.s_filter()) * nm;
        const double found = sq_of(result.heights, conditions.s_filter()) * nm;
        table.rows.push_back({known, found, found / known, 100 * result.measured_share});
        ratio.points.emplace_back(known, found / known);
    }
    // From rough to smooth: the true Sq at which the ratio first leaves the tolerance.
    double least = surface::undefined;
    bool inside = false;
    for (std::size_t k = 0; k < table.rows.size(); ++k) {
        const double off = std::abs(table.rows[k][2] - 1);
        if (off <= tolerance) {
            inside = true;
            least = table.rows[k][0];
        } else if (inside) {
            const double before = std::abs(table.rows[k - 1][2] - 1);
            const double share = (tolerance - before) / (off - before);
            least = std::exp(std::log(table.rows[k - 1][0]) * (1 - share) + std::log(table.rows[k][0]) * share);
            break;
        }
    }
    findings.figures = {{.key = "least_sq_nm",
                         .title = fmt::format("least Sq that is measured to 10 %, S-filter {:.3g} µm",
                                              conditions.s_filter() * um_per_mm),
                         .unit = "nm",
                         .value = least}};
    if (!std::isfinite(least)) {
        findings.remarks.push_back("No Sq is measured to 10 %.");
    } else if (inside && least == table.rows.back()[0]) {
        findings.remarks.push_back("The least roughness tried is measured to 10 %: the limit is below it.");
    }
    findings.charts.push_back({.title = "Measured over true Sq",
                               .x_label = "true Sq / nm",
                               .y_label = "ratio",
                               .curves = {ratio},
                               .x_decades = true});
    findings.tables.push_back(std::move(table));
    return findings;
}

} // namespace of_roughness
} // namespace

Characteristic least_roughness() {
    return {.name = "roughness",
            .title = "Least measurable roughness",
            .standard = "Irregular roughness (type AIR) with a printed texture, of Sq 1 to 0.02 um, whose waves are at "
                        "least five focus windows long.",
            .procedure = "Measured and true heights are levelled and S-filtered alike. The limit is the true Sq below "
                         "which the measured one is off by more than 10 %, between the roughnesses tried by the "
                         "logarithm.",
            .equation = R"(\left|\frac{S_{q, \mathrm{measured}}}{S_{q, \mathrm{true}}} - 1\right| = 0.1)",
            .lateral = true,
            .trials = of_roughness::trials,
            .evaluate = of_roughness::evaluate};
}

} // namespace vkfv::measurement
