#include "measurement/capability/capability_documents.hpp"

#include "core/mathematics/units.hpp"
#include "measurement/calibration/certificate.hpp"
#include "report/chart.hpp"
#include "report/colours.hpp"
#include "report/page.hpp"
#include "report/reader_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

namespace vkfv::measurement {

namespace {
namespace of_capability_documents { // files of a unity build share the unnamed namespace

using Json = nlohmann::ordered_json;
using report::reader_figure;

constexpr double percent = 100, nm_per_mm = 1e6;
constexpr double most_bias_shown = 0.5; // at the ends of the palette

std::string um_text(double mm) {
    return std::isfinite(mm) ? fmt::format("{:.3g} µm", mm * um_per_mm) : std::string("–");
}

std::string wave_text(const SurfaceWave& wave) {
    return fmt::format("wavelength {} and amplitude {}", um_text(wave.length), um_text(wave.amplitude));
}

// The property that the limit needs for a wave, beside the present one: "a noise of a height of at most 0.01 µm in
// place of 0.02 µm".
std::string needed_text(const LimitingProperties& properties, const Limit& limit, const SurfaceWave& wave) {
    constexpr double most_sine = 0.95, most_of_gases = 1.01;
    const double needed = limit.needed(properties, wave), present = properties.*limit.property;
    const bool of_aperture = limit.property == &LimitingProperties::numerical_aperture;
    const auto text = [&](double value) { return of_aperture ? fmt::format("{:.3g}", value) : um_text(value); };
    std::string words = fmt::format("{} {} in place of {}", limit.remedy, text(needed), text(present));
    if (limit.property == &LimitingProperties::pixel) {
        words += fmt::format(", by {:.3g} times the magnification or by smaller pixels", present / needed);
    }
    if (of_aperture && needed > most_sine * properties.object_index) {
        words += properties.object_index < most_of_gases
                     ? std::string(", which no objective in air has")
                     : fmt::format(", which no objective in a medium of index {:.3g} has", properties.object_index);
    }
    return words;
}

// A sentence that names the limit and the property of the instrument with which the specimen would lie on it.
std::string remedy_sentence(const LimitingProperties& properties, const Limit& limit, const SurfaceWave& wave) {
    return fmt::format("It lies beyond the limit {} ({}). For the specimen to lie on this limit, the instrument would "
                       "need {}.",
                       limit.title, limit.equation(properties), needed_text(properties, limit, wave));
}

constexpr double wanted_share = 0.9; // of Sq and Sdq, that an instrument should keep

// The instrument that would keep so much of a roughness parameter.
struct Keeper {
    const char* parameter;
    double kept;               // share that the present instrument leaves
    double period;             // mm, the longest that keeps the wanted share; NaN: none
    double pixel;              // mm, with as many in a window
    double numerical_aperture; // least
};

std::array<Keeper, 2> keepers_of(const Capability& capability) {
    const LimitingProperties& own = capability.properties;
    const RoughSpecimen& rough = capability.specimen.value();
    const KeptRoughness kept = rough.kept_by(lost_period(own));
    const auto keeper = [&](const char* parameter, double KeptRoughness::*of) {
        const SurfaceWave shortest{.length = rough.period_keeping(wanted_share, of), .amplitude = 0};
        return Keeper{.parameter = parameter,
                      .kept = kept.*of,
                      .period = shortest.length,
                      .pixel = limit_named("window").needed(own, shortest),
                      .numerical_aperture = limit_named("optics").needed(own, shortest)};
    };
    return {keeper("Sq", &KeptRoughness::sq), keeper("Sdq", &KeptRoughness::rms_slope)};
}

std::string keeper_sentence(const Capability& capability, const Keeper& keeper) {
    const std::string kept =
        fmt::format("Window and optics, as an S-filter of {}, leave {:.3g} % of the {}",
                    um_text(lost_period(capability.properties)), percent * keeper.kept, keeper.parameter);
    if (keeper.kept >= wanted_share) {
        return fmt::format("{}.", kept);
    }
    if (!std::isfinite(keeper.period)) {
        return fmt::format("{}; not even an S-filter of one pixel would leave {:.3g} %.", kept, percent * wanted_share);
    }
    const SurfaceWave shortest{.length = keeper.period, .amplitude = 0};
    const std::array keys = {"window", "optics"};
    std::vector<std::string> needed; // of what does not suffice
    needed.reserve(keys.size());
    for (const char* key : keys) {
        const Limit& limit = limit_named(key);
        if (limit.passed(capability.properties, shortest)) {
            needed.push_back(needed_text(capability.properties, limit, shortest));
        }
    }
    return fmt::format("{}. To leave {:.3g} %, waves of {} would have to be resolved, by {}.", kept,
                       percent * wanted_share, um_text(keeper.period), fmt::join(needed, ", and by "));
}

// How far the specimen lies off the map, if it does: by more than the map's spacing from the nearest sinusoid.
void add_distance(const Capability& capability, const SurfaceWave& near, std::vector<std::string>& remarks) {
    const SurfaceWave wave = capability.specimen.value().wave();
    std::vector<std::string> factors;
    const auto add = [&](const char* name, double SurfaceWave::*of) {
        const double factor = near.*of / wave.*of;
        if (std::max(factor, 1 / factor) > spacing_of_map(capability, of)) {
            factors.push_back(fmt::format("{:.3g} times its {}", factor, name));
        }
    };
    add("wavelength", &SurfaceWave::length);
    add("amplitude", &SurfaceWave::amplitude);
    if (!factors.empty()) {
        remarks.push_back(fmt::format("The specimen lies off the map: the sinusoid nearest to it has {}.",
                                      fmt::join(factors, " and ")));
    }
}

void add_specimen(const Capability& capability, std::vector<std::string>& remarks) {
    if (!capability.specimen) {
        return;
    }
    const RoughSpecimen& rough = *capability.specimen;
    const SurfaceWave wave = rough.wave();
    remarks.push_back(
        fmt::format("The specimen of the configuration has an Sq of {} and an RMS slope Sdq of {:.3g}, as "
                    "a sinusoid of {}.",
                    um_text(rough.sq), rough.rms_slope, wave_text(wave)));
    const auto passed = passed_limits(capability.properties, wave);
    for (const Limit* limit : passed) {
        remarks.push_back(remedy_sentence(capability.properties, *limit, wave));
    }
    if (passed.empty()) {
        remarks.emplace_back("It lies within all limits in closed form.");
    }
    for (const Keeper& keeper : keepers_of(capability)) {
        remarks.push_back(keeper_sentence(capability, keeper));
    }
    remarks.emplace_back(
        "Sq and Sdq are those of all heights about their least-squares plane, and contain the form of a "
        "specimen that has one.");
    const CapabilityNode& near = nearest_node(capability, wave);
    remarks.push_back(
        fmt::format("The sinusoid nearest to it on the map, of {}, is {}measured robustly: {:.3g} % of its "
                    "points are measured, and its amplitude {}.",
                    wave_text(near.wave), near.robust() ? "" : "not ", percent * near.measured_share,
                    std::isfinite(near.bias) ? fmt::format("is off by {:.3g} %", percent * near.bias)
                                             : std::string("is not found")));
    add_distance(capability, near.wave, remarks);
}

std::string colour_text(const CapabilityNode& node) {
    const report::Rgb colour = std::isfinite(node.bias) ? report::colour_of(report::Palette::signed_deviation,
                                                                            0.5 + 0.5 * node.bias / most_bias_shown)
                                                        : report::not_measured_colour;
    return fmt::format("#{:02x}{:02x}{:02x}", colour.red, colour.green, colour.blue);
}

// The limit as a line within the axes (um); what lies outside is NaN, which breaks the line. A line without a point has
// no name, and so is not in the legend.
report::Curve curve_of(const Limit& limit, const LimitingProperties& properties, const report::Axis& x,
                       const report::Axis& y) {
    constexpr int points = 200;
    report::Curve curve{.name = "", .points = {}, .spreads = {}};
    if (limit.kind == Limit::Kind::least_length) {
        const double at = limit.bound(properties, 0) * um_per_mm;
        if (at >= x.from && at <= x.to) {
            curve.name = limit.title;
            curve.points = {{at, y.from}, {at, y.to}};
        }
        return curve;
    }
    curve.points.reserve(points + 1);
    for (int k = 0; k <= points; ++k) {
        const double length = x.from * std::pow(x.to / x.from, static_cast<double>(k) / points);
        const double amplitude = limit.bound(properties, length / um_per_mm) * um_per_mm;
        const bool within = amplitude >= y.from && amplitude <= y.to;
        curve.points.emplace_back(length, within ? amplitude : surface::undefined);
        if (within) {
            curve.name = limit.title;
        }
    }
    return curve;
}

void add_nodes(report::Page& page, const Capability& capability) {
    std::vector<std::vector<std::string>> table{{"stack", "wavelength / µm", "amplitude / µm", "steepest slope / °",
                                                 "measured / %", "bias / %", "u of the bias / %", "RMS error / nm",
                                                 "noise / nm", "u / nm", "beyond 3 u / %", "robust", "beyond limits"}};
    table.reserve(capability.nodes.size() + 1);
    for (const CapabilityNode& node : capability.nodes) {
        table.push_back({node.stack, report::reader_number(node.wave.length * um_per_mm),
                         report::reader_number(node.wave.amplitude * um_per_mm),
                         reader_figure(std::atan(node.wave.steepest_slope()) / radians_per_degree),
                         reader_figure(percent * node.measured_share), reader_figure(percent * node.bias),
                         reader_figure(percent * node.bias_uncertainty), reader_figure(node.rms_error * nm_per_mm),
                         reader_figure(node.noise * nm_per_mm), reader_figure(node.uncertainty * nm_per_mm),
                         reader_figure(percent * node.beyond), node.robust() ? "yes" : "no",
                         fmt::format("{}", fmt::join(node.limits, ", "))});
    }
    page.table("Sinusoids and how they are measured", table);
}

void add_limits(report::Page& page, const Capability& capability) {
    std::vector<std::vector<std::string>> table{{"limit", "equation", "bound"}};
    const double window = capability.properties.window;
    for (const Limit& limit : limits()) {
        const double bound = limit.bound(capability.properties, window);
        const std::string at = um_text(bound);
        std::string text = at; // "–" if it is not known
        if (std::isfinite(bound)) {
            text = limit.kind == Limit::Kind::least_length
                       ? fmt::format("λ ≥ {}", at)
                       : fmt::format("A {} {} at λ = {}", limit.kind == Limit::Kind::least_amplitude ? "≥" : "≤", at,
                                     um_text(window));
        }
        table.push_back({limit.title, limit.equation(capability.properties), text});
    }
    page.table("Limits in closed form", table);
}

} // namespace of_capability_documents
} // namespace

std::vector<std::string> remarks_of(const Capability& capability) {
    std::vector<std::string> remarks;
    of_capability_documents::add_specimen(capability, remarks);
    const auto count = [&](bool robust, bool limited) {
        return std::ranges::count_if(capability.nodes, [&](const CapabilityNode& node) {
            return node.robust() == robust && node.limits.empty() != limited;
        });
    };
    remarks.push_back(fmt::format(
        "Of {} sinusoids {} are measured robustly, {} of these beyond a limit in closed form. "
        "{} within all limits are not measured robustly.",
        capability.nodes.size(), count(true, true) + count(true, false), count(true, true), count(false, false)));
    const auto lost =
        std::ranges::count_if(capability.nodes, [](const CapabilityNode& node) { return !std::isfinite(node.bias); });
    if (lost > 0) {
        remarks.push_back(fmt::format("Of {} sinusoids no amplitude is found.", lost));
    }
    if (!std::isfinite(capability.properties.noise)) {
        remarks.emplace_back("No point of the flat is measured: the noise, and its limit, are not known.");
    }
    if (capability.instrument.conditions.small) {
        const Conditions& conditions = capability.instrument.conditions;
        remarks.push_back(fmt::format("With --small the map was measured on {} x {} pixels and {}; the limits of scan "
                                      "and field are those of this part.",
                                      conditions.pixels.columns, conditions.pixels.rows, scan_text(conditions)));
    }
    return remarks;
}

nlohmann::ordered_json capability_json(const Capability& capability) {
    using of_capability_documents::Json;
    const Conditions& conditions = capability.instrument.conditions;
    const LimitingProperties& own = capability.properties;
    Json json = {{"statement", not_traceable},
                 {"limits_of_standards", smooth_standards},
                 {"program", capability.program},
                 {"configuration", capability.title},
                 {"identity_digest", capability.instrument.identity_digest},
                 {"devices", capability.devices},
                 {"first_seed", conditions.seed},
                 {"small", conditions.small},
                 {"camera", conditions.camera}};
    json["properties"] = {{"pixel_um", own.pixel * um_per_mm},
                          {"window_um", own.window * um_per_mm},
                          {"numerical_aperture", own.numerical_aperture},
                          {"object_index", own.object_index},
                          {"focus_curve_deviation_um", own.curve_deviation * um_per_mm},
                          {"scan_range_um", own.range * um_per_mm},
                          {"noise_um", own.noise * um_per_mm}};
    json["limits"] = Json::array();
    for (const Limit& limit : limits()) {
        const double bound = limit.bound(own, own.window) * um_per_mm;
        const bool of_length = limit.kind == Limit::Kind::least_length;
        json["limits"].push_back({{"key", limit.key},
                                  {"title", limit.title},
                                  {"equation", limit.equation(own)},
                                  {"wavelength_um", of_length ? Json(bound) : Json()},
                                  {"amplitude_at_one_window_um", of_length ? Json() : Json(bound)}});
    }
    json["nodes"] = Json::array();
    for (const CapabilityNode& node : capability.nodes) {
        json["nodes"].push_back({{"stack", node.stack},
                                 {"wavelength_um", node.wave.length * um_per_mm},
                                 {"amplitude_um", node.wave.amplitude * um_per_mm},
                                 {"steepest_slope", node.wave.steepest_slope()},
                                 {"measured_share", node.measured_share},
                                 {"bias", node.bias},
                                 {"bias_uncertainty", node.bias_uncertainty},
                                 {"rms_error_um", node.rms_error * um_per_mm},
                                 {"noise_um", node.noise * um_per_mm},
                                 {"uncertainty_um", node.uncertainty * um_per_mm},
                                 {"beyond_uncertainty_share", node.beyond},
                                 {"robust", node.robust()},
                                 {"beyond_limits", node.limits}});
    }
    json["specimen"] = nullptr;
    if (const auto& rough = capability.specimen) {
        const SurfaceWave wave = rough->wave();
        Json needed = Json::array();
        for (const Limit* limit : passed_limits(own, wave)) {
            needed.push_back({{"limit", limit->key},
                              {"key", limit->needed_key},
                              {"present", in_unit_of_key(*limit, own.*limit->property)},
                              {"needed", in_unit_of_key(*limit, limit->needed(own, wave))}});
        }
        json["specimen"] = {{"sq_um", rough->sq * um_per_mm},
                            {"rms_slope", rough->rms_slope},
                            {"wavelength_um", wave.length * um_per_mm},
                            {"amplitude_um", wave.amplitude * um_per_mm},
                            {"nearest_stack", nearest_node(capability, wave).stack},
                            {"beyond_limits", std::move(needed)},
                            {"kept", Json::array()}};
        for (const auto& keeper : of_capability_documents::keepers_of(capability)) {
            json["specimen"]["kept"].push_back({{"parameter", keeper.parameter},
                                                {"share", keeper.kept},
                                                {"period_um", keeper.period * um_per_mm},
                                                {"pixel_um", keeper.pixel * um_per_mm},
                                                {"numerical_aperture", keeper.numerical_aperture}});
        }
    }
    json["remarks"] = remarks_of(capability);
    return json;
}

// The nodes over wavelength and amplitude: the side of a square shows the share measured, its colour the bias.
std::string capability_map(const Capability& capability) {
    using namespace of_capability_documents;
    constexpr glm::dvec2 size(760, 480), margin(16, 16);
    constexpr double least_side = 4, more = 18;
    report::Curve places{.name = "", .points = {}, .spreads = {}};
    places.points.reserve(capability.nodes.size());
    for (const CapabilityNode& node : capability.nodes) {
        places.points.emplace_back(node.wave.length * um_per_mm, node.wave.amplitude * um_per_mm);
    }
    std::vector<report::Curve> all = {places};
    if (capability.specimen) {
        const SurfaceWave wave = capability.specimen->wave();
        all.push_back({.name = "", .points = {{wave.length * um_per_mm, wave.amplitude * um_per_mm}}, .spreads = {}});
    }
    const report::Axis x = report::axis_over(all, 0, "wavelength / µm", true);
    const report::Axis y = report::axis_over(all, 1, "amplitude / µm", true);
    std::vector<report::Curve> curves;
    curves.reserve(limits().size());
    for (const Limit& limit : limits()) {
        curves.push_back(curve_of(limit, capability.properties, x, y));
    }
    report::Svg svg;
    report::draw_chart(svg, margin, size, "Map", x, y, curves);
    const auto place = [&](glm::dvec2 value) { return report::place_in_chart(margin, size, x, y, value); };
    for (std::size_t k = 0; k < capability.nodes.size(); ++k) {
        const CapabilityNode& node = capability.nodes[k];
        const double side = least_side + more * std::sqrt(node.measured_share);
        svg.rectangle(place(places.points[k]) - glm::dvec2(0.5 * side), glm::dvec2(side),
                      fmt::format("fill=\"{}\" stroke=\"#333333\" stroke-width=\"{}\"", colour_text(node),
                                  node.robust() ? 2.5 : 0.6));
    }
    if (capability.specimen) {
        const glm::dvec2 at = place(all.back().points.front());
        for (const glm::dvec2 half : {glm::dvec2(9, 9), glm::dvec2(9, -9)}) {
            svg.line(at - half, at + half, "stroke=\"#000000\" stroke-width=\"3\"");
        }
        svg.text(at + glm::dvec2(13, 4), "specimen", "font-weight=\"bold\"");
    }
    return svg.document(size + 2.0 * margin, "Capability of the instrument over wavelength and amplitude");
}

std::string capability_page(const Capability& capability) {
    using namespace of_capability_documents;
    report::Page page;
    page.section("map", "What is measured");
    page.paragraph(not_traceable);
    for (const std::string& remark : remarks_of(capability)) {
        page.paragraph(remark);
    }
    page.picture(capability_map(capability), "Sinusoids over wavelength and amplitude, and the limits in closed form");
    page.paragraph(
        "The side of a square grows with the share of points measured. Its colour is the bias of the "
        "amplitude: white none, blue too small, red too large, full at 50 %, yellow not found. A thick edge: "
        "robust, that is 95 % of the points measured within 3 u of the truth, at most 1 % of the measured "
        "ones beyond, and the amplitude right to 10 %. The cross is the specimen, as the sinusoid of its Sq "
        "and Sdq.");
    page.section("limits", "Limits");
    page.paragraph(
        "A is the amplitude, λ the wavelength, W the focus window, w the standard deviation of a focus curve, "
        "R the scan, n the index of the medium over the specimen. The limit of a mirror holds for smooth surfaces that "
        "reflect: light that is scattered "
        "comes back from steeper slopes, as from these printed standards.");
    add_limits(page, capability);
    page.section("nodes", "Sinusoids");
    add_nodes(page, capability);
    page.paragraph(smooth_standards);
    page.section("conditions", "Conditions");
    page.picture(capability.instrument.layout, "The instrument to scale, with rays");
    auto table = conditions_table(capability.instrument.conditions);
    table.push_back({"numerical aperture", report::reader_number(capability.properties.numerical_aperture)});
    table.push_back({"index over the specimen", report::reader_number(capability.properties.object_index)});
    table.push_back({"noise of a height / nm", reader_figure(capability.properties.noise * nm_per_mm)});
    table.push_back({"device", fmt::format("{}", fmt::join(capability.devices, "; "))});
    table.push_back({"first seed", fmt::format("{}", capability.instrument.conditions.seed)});
    table.push_back({"digest of the instrument", capability.instrument.identity_digest});
    table.push_back({"program", capability.program});
    page.table("Conditions", table);
    page.folded("Configuration of the instrument", capability.instrument.toml);
    return page.document("Capability: " + capability.title, not_traceable);
}

} // namespace vkfv::measurement
