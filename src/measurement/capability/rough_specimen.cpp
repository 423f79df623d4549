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

std::optional<RoughSpecimen> roughness_of(const surface::HeightMap& heights) {
    constexpr double flat = 1e-6; // root mean square slope below which only rounding is left of a plane
    const auto levelled = surface::remove_plane(heights, surface::least_squares_plane(heights));
    const RoughSpecimen rough{.sq = surface::height_parameters(levelled).sq,
                              .rms_slope = surface::hybrid_parameters(levelled).sdq};
    return rough.sq > 0 && rough.rms_slope > flat ? std::optional(rough) : std::nullopt;
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
