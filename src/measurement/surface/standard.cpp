#include "measurement/surface/standard.hpp"

#include "core/mathematics/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace vkfv::measurement {

using dimensions::Dimension;

namespace {

// The map with every height moved towards the mean height by its own uncertainty, but no further than to it: the errors
// that brightness makes are alike where slope and curvature are, and those of tops and bottoms are opposite.
surface::HeightMap flattened(const surface::HeightMap& map, const topography::BrightnessPull& pull) {
    double sum = 0, count = 0;
    for (const double height : map.height.values) {
        if (std::isfinite(height)) {
            sum += height;
            count += 1;
        }
    }
    const double mean = count > 0 ? sum / count : 0;
    surface::HeightMap result = map;
    for (int row = 0; row < map.rows(); ++row) {
        for (int column = 0; column < map.columns(); ++column) {
            double& height = result.height(column, row);
            const double off = height - mean;
            height -= std::copysign(std::min(std::abs(off), pull.at(column, row)), off);
        }
    }
    return result;
}

} // namespace

StandardDimension::Row StandardDimension::in_unit() const {
    using enum Dimension::Unit;
    const double factor = measured.unit == length ? um_per_mm : measured.unit == angle ? 1 / radians_per_degree : 1;
    const char* unit = measured.unit == length ? "um" : measured.unit == angle ? "deg" : "";
    return {.name = measured.name,
            .rule = measured.rule,
            .unit = unit,
            .nominal = measured.nominal * factor,
            .truth = truth * factor,
            .measured = measured.value * factor,
            .deviation = (measured.value - measured.nominal) * factor,
            .error = (measured.value - truth) * factor,
            .standard_deviation = measured.standard_deviation * factor,
            .standard_error = measured.standard_error * factor,
            .brightness_uncertainty = brightness_uncertainty * factor,
            .profiles = measured.profiles};
}

bool StandardDimension::is_uncertain_by_brightness() const {
    return brightness_uncertainty > measured.standard_error;
}

std::vector<StandardDimension> standard_dimensions(const dimensions::Feature& feature,
                                                   const surface::HeightMap& measured,
                                                   const std::optional<surface::HeightMap>& truth,
                                                   const topography::BrightnessPull* pull) {
    const auto of_truth = truth ? dimensions::evaluate(*truth, feature) : std::vector<Dimension>();
    const auto moved = pull ? dimensions::evaluate(flattened(measured, *pull), feature) : std::vector<Dimension>();
    std::vector<StandardDimension> result;
    for (auto& one : dimensions::evaluate(measured, feature)) {
        const std::size_t at = result.size();
        const double true_value = truth ? of_truth.at(at).value : surface::undefined;
        const double by_brightness = pull ? std::abs(moved.at(at).value - one.value) : surface::undefined;
        result.push_back({.measured = std::move(one), .truth = true_value, .brightness_uncertainty = by_brightness});
    }
    return result;
}

nlohmann::ordered_json json_of(const std::vector<StandardDimension>& dimensions) {
    auto list = nlohmann::ordered_json::array();
    for (const auto& one : dimensions) {
        const auto row = one.in_unit();
        list.push_back({{"name", row.name},
                        {"rule", row.rule},
                        {"unit", row.unit},
                        {"nominal", row.nominal},
                        {"true", row.truth},
                        {"measured", row.measured},
                        {"deviation", row.deviation},
                        {"error", row.error},
                        {"standard_deviation", row.standard_deviation},
                        {"standard_error", row.standard_error},
                        {"brightness_uncertainty", row.brightness_uncertainty},
                        {"profiles", row.profiles}});
    }
    return list;
}

void add_dimensions(nlohmann::ordered_json& results, const std::vector<StandardDimension>& dimensions) {
    if (!dimensions.empty()) {
        results["dimensions"] = json_of(dimensions);
    }
}

std::string dimensions_text(const std::vector<StandardDimension>& dimensions) {
    std::string text;
    for (const auto& one : dimensions) {
        const auto row = one.in_unit();
        const std::string unit = row.unit.empty() ? "" : " " + row.unit;
        text += fmt::format("{:<30} ", row.name + ":");
        if (!std::isfinite(row.measured)) {
            text += "not measured: the map does not cover it, or too few of its points were measured\n";
            continue;
        }
        text += fmt::format("{:.6g}{}", row.measured, unit);
        if (std::isfinite(row.standard_error)) {
            text += fmt::format(" +- {:.2g}", row.standard_error);
        }
        if (one.is_uncertain_by_brightness()) {
            text += fmt::format(" (+- {:.2g} by brightness that changes with focus)", row.brightness_uncertainty);
        }
        if (std::isfinite(row.nominal)) {
            text += fmt::format(", nominal {:.6g} (deviation {:+.2g})", row.nominal, row.deviation);
        }
        if (std::isfinite(row.truth)) {
            text += fmt::format(", true {:.6g} (error {:+.2g})", row.truth, row.error);
        }
        text += "; " + row.rule + "\n";
    }
    return text;
}

} // namespace vkfv::measurement
