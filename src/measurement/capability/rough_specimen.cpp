#include "measurement/capability/rough_specimen.hpp"

#include "core/mathematics/pixel_grid.hpp"
#include "core/mathematics/units.hpp"
#include "measurement/scene/assembly.hpp"
#include "specimen/description.hpp"
#include "surface/filter.hpp"
#include "surface/height_parameters.hpp"
#include "surface/hybrid_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

namespace vkfv::measurement {

SurfaceWave RoughSpecimen::wave() const {
    return {.length = 2 * pi * sq / rms_slope, .amplitude = std::sqrt(2.0) * sq};
}

KeptRoughness RoughSpecimen::kept_by(double period) const {
    const auto above = std::ranges::find_if(kept, [&](const KeptRoughness& one) { return one.period >= period; });
    if (above == kept.begin() || above == kept.end()) {
        return above == kept.end() ? kept.back() : kept.front();
    }
    const KeptRoughness &shorter = *(above - 1), &longer = *above;
    const double share = std::log(period / shorter.period) / std::log(longer.period / shorter.period);
    return {.period = period,
            .sq = std::lerp(shorter.sq, longer.sq, share),
            .rms_slope = std::lerp(shorter.rms_slope, longer.rms_slope, share)};
}

double RoughSpecimen::period_keeping(double share, double KeptRoughness::*of) const {
    const auto below = std::ranges::find_if(kept, [&](const KeptRoughness& one) { return one.*of < share; });
    if (below == kept.begin()) {
        return surface::undefined;
    }
    if (below == kept.end()) {
        return kept.back().period;
    }
    const KeptRoughness &shorter = *(below - 1), &longer = *below;
    const double part = (shorter.*of - share) / (shorter.*of - longer.*of);
    return shorter.period * std::pow(longer.period / shorter.period, part);
}

std::optional<RoughSpecimen> roughness_of(const surface::HeightMap& heights) {
    constexpr double flat = 1e-6;      // root mean square slope below which only rounding is left of a plane
    constexpr double ratio = 1.4;      // of the periods that are tried, from four points to half of the map
    constexpr double least_points = 4; // the sampled S-filter of fewer points is not that of its nesting index
    const auto levelled = surface::remove_plane(heights, surface::least_squares_plane(heights));
    RoughSpecimen rough{.sq = surface::height_parameters(levelled).sq,
                        .rms_slope = surface::hybrid_parameters(levelled).sdq};
    if (!(rough.sq > 0 && rough.rms_slope > flat)) {
        return std::nullopt;
    }
    const double side = std::min(heights.height.columns * heights.pitch_x, heights.height.rows * heights.pitch_y);
    for (double period = least_points * heights.pitch_x; rough.kept.size() < 2 || period <= 0.5 * side;
         period *= ratio) {
        const auto filtered = surface::gaussian_low_pass(levelled, period);
        rough.kept.push_back({.period = period,
                              .sq = surface::height_parameters(filtered).sq / rough.sq,
                              .rms_slope = surface::hybrid_parameters(filtered).sdq / rough.rms_slope});
    }
    return rough;
}

std::optional<RoughSpecimen> rough_specimen(const Configuration& configuration, double pixel) {
    constexpr int most_pixels = 256, points_a_pixel = 4;
    const auto& description = configuration.specimen.value();
    const auto feature = specimen::feature_of(description);
    if (feature && !std::holds_alternative<dimensions::Flat>(*feature)) {
        return std::nullopt;
    }
    const ImageSize pixels = configuration.instrument.detector_pixels;
    const auto grid = PixelGrid::centred({.columns = points_a_pixel * std::min(pixels.columns, most_pixels),
                                          .rows = points_a_pixel * std::min(pixels.rows, most_pixels)},
                                         pixel / points_a_pixel);
    return roughness_of(specimen::truth(make_specimen(configuration), grid.columns, grid.rows, grid.x0, grid.y0,
                                        grid.pitch_x, grid.pitch_y));
}

} // namespace vkfv::measurement
