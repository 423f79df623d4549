#include "measurement/surface/standard.hpp"

#include "core/mathematics/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <future>
#include <utility>

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

// The map with every height replaced by the window's mean of the known heights.
surface::HeightMap averaged(const surface::HeightMap& map, const topography::FocusWindow& window) {
    Grid<float> known(map.columns(), map.rows()), heights = known;
    for (std::size_t k = 0; k < map.height.values.size(); ++k) {
        if (const double height = map.height.values[k]; std::isfinite(height)) {
            known.values[k] = 1;
            heights.values[k] = static_cast<float>(height);
        }
    }
    known = topography::window_mean(known, window);
    heights = topography::window_mean(heights, window);
    surface::HeightMap result = map;
    for (std::size_t k = 0; k < map.height.values.size(); ++k) {
        if (std::isfinite(map.height.values[k])) {
            result.height.values[k] = static_cast<double>(heights.values[k] / known.values[k]);
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
            .window_uncertainty = window_uncertainty * factor,
            .profiles = measured.profiles};
}

std::vector<StandardDimension> standard_dimensions(const dimensions::Feature& feature,
                                                   const surface::HeightMap& measured,
                                                   const std::optional<surface::HeightMap>& truth,
                                                   const std::optional<FocusEffects>& effects) {
    auto later_nearer = std::async(std::launch::async, [&] {
        return effects ? dimensions::evaluate(flattened(measured, *effects->pull), feature) : std::vector<Dimension>();
    });
    auto later_wider = std::async(std::launch::async, [&] {
        return effects ? dimensions::evaluate(averaged(measured, effects->window), feature) : std::vector<Dimension>();
    });
    const auto of_truth = truth ? dimensions::evaluate(*truth, feature) : std::vector<Dimension>();
    const auto nearer = later_nearer.get(), wider = later_wider.get();
    std::vector<StandardDimension> result;
    for (auto& one : dimensions::evaluate(measured, feature)) {
        const std::size_t at = result.size();
        const auto moved_by = [&](const std::vector<Dimension>& others) {
            return effects ? std::abs(others.at(at).value - one.value) : surface::undefined;
        };
        const double by_brightness = moved_by(nearer), by_window = moved_by(wider);
        result.push_back({.measured = std::move(one),
                          .truth = truth ? of_truth.at(at).value : surface::undefined,
                          .brightness_uncertainty = by_brightness,
                          .window_uncertainty = by_window});
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
                        {"window_uncertainty", row.window_uncertainty},
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
        // An uncertainty below the standard error adds little to it by squares, so the text leaves it out.
        if (row.brightness_uncertainty > row.standard_error) {
            text += fmt::format(", +- {:.2g} by brightness that changes with focus", row.brightness_uncertainty);
        }
        if (row.window_uncertainty > row.standard_error) {
            text += fmt::format(", +- {:.2g} by the focus window", row.window_uncertainty);
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
