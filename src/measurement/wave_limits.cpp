#include "measurement/wave_limits.hpp"

#include "core/units.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace vkfv::measurement {

namespace {

constexpr double most_error = 0.1;

} // namespace

FieldWaves::FieldWaves(const optics::Instrument& instrument) {
    const auto begin = [&instrument](glm::dvec2 field) {
        return std::async(std::launch::async,
                          [&instrument, field] { return optics::point_for_filter(instrument, field); });
    };
    corner = begin(instrument.first_order.field_corner);
    edge = begin({instrument.first_order.field_edge, 0});
}

WaveLimits wave_limits(const optics::PupilFilter& filter, const optics::Instrument& instrument, FieldWaves waves) {
    const double reach = optics::reach_of_filter(instrument);
    WaveLimits limits{.cells = static_cast<int>(filter.cells().side),
                      .parts = static_cast<int>(filter.cells().parts),
                      .asked_parts = optics::parts_for_waves(instrument),
                      .folded_contrast = filter.folded_contrast(),
                      .points = {}};
    auto corner =
        std::async(std::launch::async, [&] { return optics::largest_filter_error(filter, waves.corner.get(), reach); });
    limits.points.push_back({.name = "axis", .error = optics::largest_filter_error(filter, instrument, glm::dvec2(0))});
    limits.points.push_back({.name = "edge", .error = optics::largest_filter_error(filter, waves.edge.get(), reach)});
    limits.points.push_back({.name = "corner", .error = corner.get()});
    return limits;
}

WaveLimits wave_limits(const optics::PupilFilter& filter, const optics::Instrument& instrument) {
    return wave_limits(filter, instrument, FieldWaves(instrument));
}

std::vector<std::string> warnings_of(const WaveLimits& limits) {
    std::vector<std::string> warnings;
    const auto worst =
        std::ranges::max_element(limits.points, {}, [](const auto& point) { return point.error.difference; });
    if (worst != limits.points.end() && worst->error.difference > most_error) {
        const auto& error = worst->error;
        const bool of_cells = limits.points.front().error.difference > 0.5 * error.difference;
        warnings.push_back(fmt::format(
            "Images as waves make them: {} the contrast of waves of {:.3g} um at z = {:.3g} um is off by {:.2g}, phase "
            "included ({:.2g} instead of {:.2g}). {}",
            std::string_view(worst->name) == "axis" ? "in the middle of the field"
                                                    : fmt::format("at the {} of the field", worst->name),
            um_per_mm / glm::length(error.frequency), error.height * um_per_mm, error.difference,
            std::abs(error.filtered), std::abs(error.waves),
            of_cells ? "Take more diffraction.cells." : "The filter is that of the axis: trust what lies near it."));
    }
    if (limits.folded_contrast > 0) {
        warnings.push_back(fmt::format(
            "Light of waves is sorted in {} parts of a pixel's side, where the numerical aperture asks for {}: finer "
            "waves fold back, and their contrast is off by up to {:.2g}. Take fewer detector.pixels, fewer "
            "diffraction.cells, or a device with more memory.",
            limits.parts, limits.asked_parts, limits.folded_contrast));
    }
    return warnings;
}

nlohmann::ordered_json json_of(const WaveLimits& limits) {
    nlohmann::ordered_json json = {{"cells", limits.cells},
                                   {"parts_per_pixel", limits.parts},
                                   {"parts_asked_for", limits.asked_parts},
                                   {"folded_contrast", limits.folded_contrast}};
    for (const auto& [name, error] : limits.points) {
        json[fmt::format("contrast_error_{}", name)] = error.difference;
    }
    return json;
}

std::string summary(const WaveLimits& limits) {
    std::string text = "largest error of contrast as the filter of the axis makes it, within two depths of field\n";
    for (const auto& [name, error] : limits.points) {
        text += fmt::format("{:8} {:8.4f}  at {:.4g} cycles/mm, z = {:.4g} um: {:.4f} instead of {:.4f}\n", name,
                            error.difference, glm::length(error.frequency), error.height * um_per_mm,
                            std::abs(error.filtered), std::abs(error.waves));
    }
    return text;
}

} // namespace vkfv::measurement
