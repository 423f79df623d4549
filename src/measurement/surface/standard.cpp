#include "measurement/surface/standard.hpp"

#include "core/mathematics/units.hpp"

#include <fmt/format.h>

#include <cmath>

namespace vkfv::measurement {

using dimensions::Dimension;

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
            .profiles = measured.profiles};
}

std::vector<StandardDimension> standard_dimensions(const dimensions::Feature& feature,
                                                   const surface::HeightMap& measured,
                                                   const std::optional<surface::HeightMap>& truth) {
    const auto of_truth = truth ? dimensions::evaluate(*truth, feature) : std::vector<Dimension>();
    std::vector<StandardDimension> result;
    for (auto& one : dimensions::evaluate(measured, feature)) {
        const double true_value = truth ? of_truth.at(result.size()).value : surface::undefined;
        result.push_back({.measured = std::move(one), .truth = true_value});
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
