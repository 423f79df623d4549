// Lateral amplification, perpendicularity and mapping deviations: ISO 25178-600, on a cross grating.
#include "core/mathematics/units.hpp"
#include "dimensions/lattice_nodes.hpp"
#include "measurement/calibration/standards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vkfv::measurement {

namespace {
namespace of_lattices { // files of a unity build share the unnamed namespace

constexpr std::array<const char*, 3> places = {"bottom", "middle", "top"};
constexpr std::size_t middle_place = 1;
constexpr double least_periods = 5; // a node takes a period to either side

double pitch_of(const Conditions& conditions) {
    constexpr double windows = 4;
    return windows * conditions.window;
}

// The depth of the grating (mm): its edges are seen, and most of the scan is left for its three places.
double depth_of(const Conditions& conditions) {
    return std::min(conditions.curve_deviation, 0.5 * conditions.usable_range());
}

std::vector<Trial> trials(const Conditions& conditions, std::vector<std::string>& remarks) {
    if (conditions.field() < least_periods * pitch_of(conditions)) {
        remarks.push_back("The field is narrower than 20 focus windows: it holds too few periods of a grating that the "
                          "window resolves.");
        return {};
    }
    if (conditions.usable_range() < 4 * conditions.step) {
        remarks.push_back("The scan is shorter than four standard deviations of a focus curve and four steps.");
        return {};
    }
    const double depth = depth_of(conditions), pitch = pitch_of(conditions);
    const double room = 0.5 * (conditions.usable_range() - depth);
    std::vector<Trial> list;
    for (std::size_t k = 0; k < places.size(); ++k) {
        const double aside = (static_cast<double>(k) - 1) * room;
        list.push_back({.name = places[k],
                        .specimen = standard_of(conditions, "cross-grating",
                                                fmt::format("period_um = {}\ndepth_um = {}\n", um(pitch), um(depth)),
                                                0.5 * conditions.pitch) +
                                    printed(conditions, usual_contrast, static_cast<std::uint32_t>(k + 1)) +
                                    placed_at(0, 0, conditions.middle() + 0.5 * depth + aside),
                        .overrides = repetition(conditions, static_cast<int>(k))});
    }
    return list;
}

Findings evaluate(const Conditions& conditions, std::span<const TrialResult> results) {
    const double pitch = pitch_of(conditions);
    const dimensions::CrossGrating grating{.frame = {}, .pitch_u = pitch, .pitch_v = pitch, .angle = 0.5 * pi};
    Findings findings;
    CertificateTable table{.caption = "Lateral scales at three heights",
                           .columns = {"z / µm", "nodes", "α_x", "α_y", "u of both", "perpendicularity / °",
                                       "largest deviation / µm", "scatter of a node / µm"},
                           .rows = {}};
    constexpr double wished_periods = 12; // ten nodes along a side
    for (std::size_t k = 0; k < results.size(); ++k) {
        const auto nodes = dimensions::lattice_nodes(results[k].heights, grating);
        const auto map = dimensions::lattice_map(nodes);
        const double z = conditions.middle() +
                         (static_cast<double>(k) - 1) * 0.5 * (conditions.usable_range() - depth_of(conditions));
        if (!map) {
            findings.remarks.push_back(fmt::format("Too few nodes were measured at the {} of the scan.", places[k]));
            continue;
        }
        // Axes that stand at more than a right angle see the lattice's at less than one.
        const double perpendicularity = -map->perpendicularity;
        table.rows.push_back({z * um_per_mm, static_cast<double>(nodes.size()), map->amplification_u,
                              map->amplification_v, map->amplification_error, perpendicularity / radians_per_degree,
                              map->largest_deviation * um_per_mm, map->scatter * um_per_mm});
        if (k != middle_place) {
            continue;
        }
        const double freedom = 2.0 * static_cast<double>(nodes.size()) - 6;
        for (const auto& [name, value] : {std::pair{"x", map->amplification_u}, std::pair{"y", map->amplification_v}}) {
            findings.figures.push_back({.key = fmt::format("alpha_{}", name),
                                        .title = fmt::format("alpha_{}", name),
                                        .unit = "",
                                        .value = value,
                                        .standard_uncertainty = map->amplification_error,
                                        .degrees_of_freedom = freedom});
        }
        findings.figures.push_back({.key = "perpendicularity_deg",
                                    .title = "perpendicularity, the angle from the instrument's x to its y less 90°",
                                    .unit = "deg",
                                    .value = perpendicularity / radians_per_degree,
                                    .standard_uncertainty = map->perpendicularity_error / radians_per_degree,
                                    .degrees_of_freedom = freedom});
        findings.figures.push_back({.key = "mapping_deviation_um",
                                    .title = "largest x-y mapping deviation",
                                    .unit = "um",
                                    .value = map->largest_deviation * um_per_mm,
                                    .standard_uncertainty = map->scatter * um_per_mm,
                                    .degrees_of_freedom = freedom});
    }
    findings.tables.push_back(std::move(table));
    if (conditions.field() < wished_periods * pitch) {
        findings.remarks.push_back(
            fmt::format("The field holds {:.3g} periods; 12 are wished for.", conditions.field() / pitch));
    }
    return findings;
}

} // namespace of_lattices
} // namespace

Characteristic lateral_mapping() {
    return {.name = "alpha_xy",
            .title = "Lateral amplification, perpendicularity and mapping",
            .standard =
                "A cross grating (type ACG) of a pitch of four focus windows, at the bottom, the middle and the "
                "top of the scan.",
            .procedure = "The phases of both fundamental waves about each node tell where it lies. An affine map from "
                         "the nominal to the measured places, by least squares, gives the amplifications and the "
                         "perpendicularity at the middle of the scan; the largest distance that it leaves is the "
                         "mapping deviation. Uncertainties are those of the nodes' scatter about the map, which "
                         "includes the deviations themselves.",
            .equation = R"(\binom{x_i}{y_i} = \begin{pmatrix} \alpha_x & s \\ t & \alpha_y \end{pmatrix} )"
                        R"(\binom{x_{i, \mathrm{nominal}}}{y_{i, \mathrm{nominal}}} + \vec{b} + )"
                        R"(\vec{e}_i, \quad \sum_i |\vec{e}_i|^2 = \min)",
            .lateral = true,
            .trials = of_lattices::trials,
            .evaluate = of_lattices::evaluate};
}

} // namespace vkfv::measurement
