#include "measurement/capability/limits.hpp"

#include "core/mathematics/units.hpp"
#include "measurement/judgement/expectation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string_view>

namespace vkfv::measurement {

namespace {
namespace of_limits { // files of a unity build share the unnamed namespace

using Kind = Limit::Kind;
using Properties = LimitingProperties;

constexpr double noises = 3; // of the limit of detection

// The tangent of the angle between the axis and the rim of the cone of light.
double slope_of_cone(const Properties& own) {
    return std::tan(std::asin(std::min(own.numerical_aperture / own.object_index, 1.0)));
}

bool is_box(const Properties& own) {
    return own.window_shape == topography::WindowShape::box;
}

// The standard deviation (mm) of the places in a window of this width (mm) along a line.
double deviation_in_window(topography::WindowShape shape, double width) {
    return shape == topography::WindowShape::box ? width / std::sqrt(12.0) : width / 5;
}

} // namespace of_limits
} // namespace

double SurfaceWave::steepest_slope() const {
    return 2 * pi * amplitude / length;
}

double lost_period(const LimitingProperties& properties) {
    return std::max(properties.window_period, properties.resolution);
}

LimitingProperties limiting_properties(const TestedInstrument& instrument, topography::WindowShape shape,
                                       double noise) {
    const Conditions& conditions = instrument.conditions;
    return {.pixel = conditions.pitch,
            .window = conditions.window,
            .window_shape = shape,
            .window_period = period_of_half_in_window(shape, conditions.window),
            .window_deviation = of_limits::deviation_in_window(shape, conditions.window),
            .resolution = conditions.resolution,
            .numerical_aperture = instrument.numerical_aperture,
            .object_index = instrument.object_index,
            .curve_deviation = conditions.curve_deviation,
            .range = conditions.range,
            .usable_range = conditions.usable_range(),
            .noise = noise};
}

bool Limit::passed(const LimitingProperties& properties, const SurfaceWave& wave) const {
    const double at = bound(properties, wave.length);
    switch (kind) {
    case Kind::least_length:
        return wave.length < at;
    case Kind::largest_amplitude:
        return wave.amplitude > at;
    case Kind::least_amplitude:
        return wave.amplitude < at;
    }
    return false;
}

const std::array<Limit, 6>& limits() {
    using namespace of_limits;
    static const std::array<Limit, 6> all = {{
        {.key = "window",
         .title = "focus window",
         .needed_key = "pixel_um",
         .remedy = "pixels, with as many in a window, of at most",
         .equation = [](const Properties& own) { return is_box(own) ? "λ = 1.66 W" : "λ = 1.07 W"; },
         .kind = Kind::least_length,
         .property = &Properties::pixel,
         .bound = [](const Properties& own, double) { return own.window_period; },
         .needed = [](const Properties& own,
                      const SurfaceWave& wave) { return own.pixel * wave.length / own.window_period; }},
        {.key = "optics",
         .title = "optical resolution",
         .needed_key = "numerical_aperture",
         .remedy = "a numerical aperture of at least",
         .equation = [](const Properties&) { return "λ = 0.61 λ_light / NA"; },
         .kind = Kind::least_length,
         .property = &Properties::numerical_aperture,
         .bound = [](const Properties& own, double) { return own.resolution; },
         .needed = [](const Properties& own,
                      const SurfaceWave& wave) { return own.numerical_aperture * own.resolution / wave.length; }},
        {.key = "slope",
         .title = "slope of a mirror",
         .needed_key = "numerical_aperture",
         .remedy = "a numerical aperture of at least",
         .equation = [](const Properties&) { return "for smooth surfaces only: 2 π A / λ = tan(asin(NA / n))"; },
         .kind = Kind::largest_amplitude,
         .property = &Properties::numerical_aperture,
         .bound = [](const Properties& own, double length) { return length * slope_of_cone(own) / (2 * pi); },
         .needed =
             [](const Properties& own, const SurfaceWave& wave) {
                 return own.object_index * std::sin(std::atan(wave.steepest_slope()));
             }},
        {.key = "relief",
         .title = "relief within the window",
         .needed_key = "window_um",
         .remedy = "with the same focus curve, a window of at most",
         .equation =
             [](const Properties& own) { return is_box(own) ? "2 π A W / (λ √12) = w" : "2 π A W / (5 λ) = w"; },
         .kind = Kind::largest_amplitude,
         .property = &Properties::window,
         .bound = [](const Properties& own,
                     double length) { return own.curve_deviation * length / (2 * pi * own.window_deviation); },
         .needed =
             [](const Properties& own, const SurfaceWave& wave) {
                 return own.window * own.curve_deviation / (own.window_deviation * wave.steepest_slope());
             }},
        {.key = "noise",
         .title = "measurement noise",
         .needed_key = "noise_um",
         .remedy = "a noise of a height of at most",
         .equation = [](const Properties&) { return "A = 3 times the noise of a height"; },
         .kind = Kind::least_amplitude,
         .property = &Properties::noise,
         .bound = [](const Properties& own, double) { return noises * own.noise; },
         .needed = [](const Properties&, const SurfaceWave& wave) { return wave.amplitude / noises; }},
        {.key = "scan",
         .title = "scan",
         .needed_key = "scan_range_um",
         .remedy = "a scan of at least",
         .equation = [](const Properties&) { return "2 A = R − 4 w"; },
         .kind = Kind::largest_amplitude,
         .property = &Properties::range,
         .bound = [](const Properties& own, double) { return 0.5 * own.usable_range; },
         .needed = [](const Properties& own,
                      const SurfaceWave& wave) { return own.range - own.usable_range + 2 * wave.amplitude; }},
    }};
    return all;
}

const Limit& limit_named(std::string_view key) {
    const auto found = std::ranges::find(limits(), key, [](const Limit& one) { return std::string_view(one.key); });
    if (found == limits().end()) {
        throw std::out_of_range(fmt::format("no limit {}", key));
    }
    return *found;
}

std::vector<const Limit*> passed_limits(const LimitingProperties& properties, const SurfaceWave& wave) {
    std::vector<const Limit*> passed;
    for (const Limit& limit : limits()) {
        if (limit.passed(properties, wave)) {
            passed.push_back(&limit);
        }
    }
    return passed;
}

double in_unit_of_key(const Limit& limit, double value) {
    return std::string_view(limit.needed_key).ends_with("_um") ? value * um_per_mm : value;
}

std::vector<std::string> keys_of(const std::vector<const Limit*>& passed) {
    std::vector<std::string> keys;
    keys.reserve(passed.size());
    std::ranges::transform(passed, std::back_inserter(keys), [](const Limit* limit) { return limit->key; });
    return keys;
}

} // namespace vkfv::measurement
