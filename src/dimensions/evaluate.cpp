#include "dimensions/evaluate.hpp"

#include "core/mathematics/units.hpp"
#include "dimensions/levels.hpp"
#include "dimensions/sphere_form.hpp"
#include "dimensions/transfer.hpp"
#include "dimensions/waves.hpp"
#include "surface/filter.hpp"
#include "surface/height_parameters.hpp"
#include "surface/minimum_zone.hpp"

#include <fmt/format.h>

namespace vkfv::dimensions {
namespace {

using surface::HeightMap;
using Dimensions = std::vector<Dimension>;
using enum Dimension::Unit;

constexpr const char* levels_rule = "ISO 5436-1";
constexpr const char* edge_rule = "after ISO 5436-1";
constexpr const char* fit_rule = "least squares";

void take(Dimension& dimension, const Mean& mean) {
    dimension.value = mean.mean;
    dimension.standard_deviation = mean.standard_deviation;
    dimension.standard_error = mean.standard_error;
    dimension.profiles = mean.count;
}

Dimensions of_levels(const std::string& name, const char* rule, double nominal,
                     const std::optional<LevelDifference>& levels) {
    Dimension by_profiles{.name = name, .rule = rule, .nominal = nominal};
    Dimension areal{.name = name + ", areal", .rule = rule, .nominal = nominal};
    if (levels) {
        take(by_profiles, levels->profiles);
        areal.value = levels->areal;
        areal.standard_error = levels->profiles.standard_error; // the areal value uses the profiles' points
    }
    return {by_profiles, areal};
}

Dimensions of(const HeightMap& map, const Step& step) {
    return of_levels("step height", edge_rule, step.height, step_height(map, step));
}

Dimensions of(const HeightMap& map, const Groove& groove) {
    const auto depth = groove_depth(map, groove);
    auto result =
        of_levels(groove.depth < 0 ? "ridge height" : "groove depth", levels_rule, std::abs(groove.depth), depth);
    Dimension width{.name = "width at half depth", .rule = levels_rule, .nominal = groove.width};
    if (const auto mean = depth ? groove_width(map, groove, *depth) : std::nullopt)
        take(width, *mean);
    result.push_back(width);
    return result;
}

Dimensions of(const HeightMap& map, const Prism& prism) {
    Dimension before{.name = "flank angle, first", .rule = fit_rule, .unit = angle, .nominal = prism.flank_angle};
    Dimension behind = before;
    behind.name = "flank angle, second";
    Dimension between{
        .name = "angle between the flanks", .rule = fit_rule, .unit = angle, .nominal = pi - 2 * prism.flank_angle};
    if (const auto angles = flank_angles(map, prism)) {
        take(before, angles->before);
        take(behind, angles->behind);
        between.value = pi - before.value - behind.value; // independent of a tilt of the map
        between.standard_error = std::hypot(before.standard_error, behind.standard_error);
    }
    return {before, behind, between};
}

Dimension period_of(const std::string& name, double nominal) {
    return {.name = name, .rule = fit_rule, .nominal = nominal};
}

void take_period(Dimension& dimension, const Wave& wave) {
    dimension.value = wave.period();
    dimension.standard_error = wave.period_error;
}

void take_amplitude(Dimension& dimension, const Wave& wave) {
    dimension.value = wave.amplitude;
    dimension.standard_error = wave.amplitude_error;
}

// The frequency (cycles per mm along x and y) of a wave along u, rotated by `angle` (rad).
std::array<double, 2> frequency_across(const Frame& frame, double period, double angle = 0) {
    return {std::cos(frame.angle + angle) / period, std::sin(frame.angle + angle) / period};
}

Dimensions of(const HeightMap& map, const Grating& grating) {
    Dimension pitch = period_of("pitch", grating.period);
    const auto found = fitted_waves(map, grating.frame, {frequency_across(grating.frame, grating.period)});
    std::optional<LevelDifference> depth;
    if (found) {
        const Wave& wave = found->waves.front();
        take_period(pitch, wave);
        // The levels are evaluated on the lines that the map shows, not on the nominal ones.
        Grating shown = grating;
        shown.period = wave.period();
        shown.line_width *= shown.period / grating.period;
        shown.frame.angle = std::atan2(wave.frequency[1], wave.frequency[0]);
        const double shift = wave.phase / (2 * pi) * shown.period;
        shown.frame.x += shift * std::cos(shown.frame.angle);
        shown.frame.y += shift * std::sin(shown.frame.angle);
        if (grating.line_width > 0)
            depth = line_depth(map, shown);
    }
    Dimensions result{pitch};
    if (grating.line_width > 0) {
        const auto levels = of_levels("depth", levels_rule, grating.depth, depth);
        result.insert(result.end(), levels.begin(), levels.end());
    }
    return result;
}

// The angle between two waves, 0 to pi.
double angle_between(const Wave& first, const Wave& second) {
    const auto &a = first.frequency, &b = second.frequency;
    return std::atan2(std::abs(a[0] * b[1] - a[1] * b[0]), a[0] * b[0] + a[1] * b[1]);
}

Dimensions of(const HeightMap& map, const CrossGrating& grating) {
    Dimension u = period_of("pitch, first", grating.pitch_u), v = period_of("pitch, second", grating.pitch_v);
    Dimension between{.name = "angle between", .rule = fit_rule, .unit = angle, .nominal = grating.angle};
    if (const auto found = fitted_waves(map, grating.frame,
                                        {frequency_across(grating.frame, grating.pitch_u),
                                         frequency_across(grating.frame, grating.pitch_v, grating.angle)})) {
        take_period(u, found->waves[0]);
        take_period(v, found->waves[1]);
        between.value = angle_between(found->waves[0], found->waves[1]);
        between.standard_error = found->angle_error;
    }
    return {u, v, between};
}

Dimensions of(const HeightMap& map, const Sinusoid& sinusoid) {
    Dimension amplitude{.name = "amplitude", .rule = fit_rule, .nominal = sinusoid.amplitude};
    Dimension period = period_of("period", sinusoid.period);
    if (const auto found = fitted_waves(map, sinusoid.frame, {frequency_across(sinusoid.frame, sinusoid.period)})) {
        take_amplitude(amplitude, found->waves.front());
        take_period(period, found->waves.front());
    }
    return {amplitude, period};
}

Dimensions of(const HeightMap& map, const CrossSinusoid& cross) {
    Dimension first{.name = "amplitude, first", .rule = fit_rule, .nominal = cross.amplitude};
    Dimension second{.name = "amplitude, second", .rule = fit_rule, .nominal = cross.amplitude};
    Dimension u = period_of("period, first", cross.period_u), v = period_of("period, second", cross.period_v);
    if (const auto found = fitted_waves(
            map, cross.frame,
            {frequency_across(cross.frame, cross.period_u), frequency_across(cross.frame, cross.period_v, 0.5 * pi)})) {
        take_amplitude(first, found->waves[0]);
        take_amplitude(second, found->waves[1]);
        take_period(u, found->waves[0]);
        take_period(v, found->waves[1]);
    }
    return {first, second, u, v};
}

Dimensions of(const HeightMap& map, const RadialSinusoid& radial) {
    Dimension amplitude{.name = "amplitude", .rule = fit_rule, .nominal = radial.amplitude};
    Dimension period = period_of("period", radial.period);
    if (const auto found = fitted_radial_wave(map, radial.frame, 1 / radial.period)) {
        take_amplitude(amplitude, found->waves.front());
        take_period(period, found->waves.front());
    }
    return {amplitude, period};
}

Dimensions of_transfer(const std::vector<Transfer>& transfers, const std::string& of_limit) {
    Dimensions result;
    for (const auto& one : transfers)
        result.push_back({.name = fmt::format("transfer at {:.4g} um", one.period * um_per_mm),
                          .rule = fit_rule,
                          .unit = ratio,
                          .nominal = 1,
                          .value = one.ratio,
                          .standard_error = one.standard_error});
    result.push_back(
        {.name = of_limit, .rule = fit_rule, .value = period_at_half(transfers).value_or(surface::undefined)});
    return result;
}

Dimensions of(const HeightMap& map, const Chirp& chirp) {
    return of_transfer(chirp_transfer(map, chirp), "period of transfer 0.5");
}

Dimensions of(const HeightMap& map, const Star& star) {
    return of_transfer(star_transfer(map, star), "lateral period limit");
}

Dimensions of(const HeightMap& map, const SphereCap& cap) {
    Dimension radius{.name = "radius", .rule = fit_rule, .nominal = cap.radius};
    Dimension sz{.name = "form deviation Sz", .rule = fit_rule, .nominal = 0};
    Dimension sq{.name = "form deviation Sq", .rule = fit_rule, .nominal = 0};
    // Without a radius the whole map lies on the sphere.
    if (const auto form = cap.radius > 0 ? sphere_form(map, cap) : sphere_form(map)) {
        radius.value = form->sphere.radius;
        radius.standard_error = form->radius_error;
        sz.value = form->peak_to_valley;
        sq.value = form->rms;
    }
    return {radius, sz, sq};
}

Dimensions of(const HeightMap& map, const Flat&) {
    Dimension sz{.name = "flatness Sz", .rule = fit_rule, .nominal = 0};
    Dimension sq{.name = "flatness Sq", .rule = fit_rule, .nominal = 0};
    const auto parameters = surface::height_parameters(surface::remove_plane(map, surface::least_squares_plane(map)));
    sz.value = parameters.sz;
    sq.value = parameters.sq;
    Dimension least{.name = "flatness, minimum zone", .rule = "ISO 12781-1", .nominal = 0};
    least.value = surface::minimum_zone(map);
    return {sz, sq, least};
}

Dimensions of(const HeightMap& map, const Plateaus& plateaus) {
    Dimensions result;
    for (const auto& one : plateau_heights(map, plateaus))
        result.push_back({.name = fmt::format("plateau of {:.4g} um", one.nominal * um_per_mm),
                          .rule = edge_rule,
                          .nominal = one.nominal,
                          .value = one.height,
                          .standard_error = one.standard_error});
    return result;
}

} // namespace

Dimensions evaluate(const HeightMap& map, const Feature& feature) {
    return std::visit([&](const auto& one) { return of(map, one); }, feature);
}

} // namespace vkfv::dimensions
