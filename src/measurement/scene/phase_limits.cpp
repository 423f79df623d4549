#include "measurement/scene/phase_limits.hpp"

#include "core/mathematics/pixel_grid.hpp"
#include "core/mathematics/units.hpp"
#include "measurement/scene/pupil_light.hpp"
#include "specimen/description.hpp"
#include "surface/filter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace vkfv::measurement {

namespace {

// The error of contrast above which the light counts as too narrow. A mirror lit with 0.8 of the aperture has this
// error: it passes frequencies up to 1.8 NA / lambda, where a filled pupil's contrast is 0.04.
constexpr double most_contrast_error = 0.2;
constexpr double mirror_like = 0.25; // scatter_fill below which a surface changes the phase of light alone

constexpr double resolutions_of_texture = 10;
constexpr int most_points = 256;               // on a side of the part of the field whose texture is measured
constexpr double deviations_a_median = 1.4826; // of a normal distribution
constexpr double flat = 1e-9;                  // mm, rounding of heights that are meant to be equal

double median_of(std::vector<double> values) {
    if (values.empty()) {
        return 0;
    }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

// incoming: unit vector from the middle of the source, or from the middle of a ring's band.
double scatter_fill_of(const specimen::Material& material, glm::dvec3 incoming, double aperture_sine) {
    constexpr std::uint32_t paths = 8192, most_paths = 262144;
    // An aperture of 0.05 receives 650 of most_paths from a Lambertian surface, and the median is then good to 2 %.
    // Where fewer than `fewest` enter, light comes in by the specimen's slopes and not by its lobes.
    constexpr std::size_t enough = 400, fewest = 30;
    constexpr std::uint32_t seed = 1, blocks_of_emission = 1;
    const auto record = specimen::material_record(material);
    const MaterialScene scene(material);
    std::vector<double> sines;
    for (std::uint32_t path = 0; path < paths || (path < most_paths && sines.size() < enough); ++path) {
        const auto scattered =
            physics::f64::scatter(scene, record, incoming, {0, 0, 1}, seed, 0, {path, 0}, blocks_of_emission);
        const double sine = std::hypot(scattered.direction.x, scattered.direction.y);
        if (scattered.accepted && sine <= aperture_sine) {
            sines.push_back(sine);
        }
    }
    const double of_filled = aperture_sine * std::sqrt(0.5);
    return sines.size() < fewest ? 0 : std::min(1.0, median_of(std::move(sines)) / of_filled);
}

// The source of the description with the most flux, and the instrument with this source.
struct StrongestLight {
    const optics::SourceDescription* source;
    const optics::Instrument* instrument;
};

StrongestLight strongest_of(const optics::InstrumentDescription& description, const optics::Instrument& instrument) {
    const auto sources = description.sources();
    const auto lights = instrument.lights();
    const auto strongest = std::ranges::max_element(sources, {}, &optics::SourceDescription::flux);
    return {.source = *strongest, .instrument = lights[static_cast<std::size_t>(strongest - sources.begin())]};
}

double source_fill_of(const optics::InstrumentDescription& description, const StrongestLight& light) {
    const double filling = light.instrument->first_order.pupil_radius_in_source;
    if (light.source->ring || !(filling > 0)) {
        return 0;
    }
    const double radius = light.source->inner_radius();
    return std::min(1.0, std::min(radius, description.illumination_aperture_radius.value_or(radius)) / filling);
}

double texture_of(const specimen::Specimen& specimen, const optics::Instrument& instrument, double resolution) {
    const auto pixels = instrument.detector_pixels();
    const double pitch = instrument.first_order.pixel_pitch;
    const int columns = std::min(pixels.columns, most_points);
    const int rows = std::min(pixels.rows, most_points);
    const auto grid = PixelGrid::centred(columns, rows, pitch);
    const auto heights = specimen::truth(specimen, columns, rows, grid.x0, grid.y0, grid.pitch_x, grid.pitch_y);
    const auto smooth = surface::gaussian_low_pass(heights, std::max(resolutions_of_texture * resolution, 4 * pitch));
    std::vector<double> deviations;
    double square = 0;
    for (std::size_t k = 0; k < heights.height.values.size(); ++k) {
        const double deviation = std::abs(heights.height.values[k] - smooth.height.values[k]);
        if (std::isfinite(deviation)) {
            deviations.push_back(deviation);
            square += deviation * deviation;
        }
    }
    if (deviations.empty()) {
        return 0;
    }
    const double standard_deviation = std::sqrt(square / static_cast<double>(deviations.size()));
    return std::min(standard_deviation, deviations_a_median * median_of(std::move(deviations)));
}

} // namespace

bool PhaseLimits::fills_pupil() const {
    return contrast_error <= most_contrast_error;
}

bool PhaseLimits::is_relief_of_phase() const {
    return scatter_fill < mirror_like && texture > flat && texture < phase_height;
}

double PhaseLimits::height_uncertainty() const {
    return fills_pupil() && !is_relief_of_phase() ? 0 : depth_of_field;
}

PhaseLimits phase_limits(const optics::InstrumentDescription& description, const optics::Instrument& instrument,
                         const specimen::Specimen& specimen) {
    const auto& first_order = instrument.first_order;
    const double wavelength = description.spectrum.reference_um * mm_per_um;
    const double resolution = wavelength / (2 * first_order.numerical_aperture);
    const StrongestLight light = strongest_of(description, instrument);
    glm::dvec3 incoming(0, 0, -1);
    if (const auto& ring = light.source->ring) {
        incoming = {std::cos(ring->elevation), 0, -std::sin(ring->elevation)};
    }
    const double aperture_sine = first_order.numerical_aperture / first_order.object_index;
    return {.contrast_error = contrast_error_of(
                pupil_light(description, *light.source, *light.instrument, specimen.material, aperture_sine)),
            .scatter_fill = scatter_fill_of(specimen.material, incoming, aperture_sine),
            .source_fill = source_fill_of(description, light),
            .texture = texture_of(specimen, instrument, resolution),
            .filling_radius = light.source->ring ? 0 : light.instrument->first_order.pupil_radius_in_source,
            .source_radius = light.source->ring ? 0 : light.source->inner_radius(),
            .phase_height = wavelength / (4 * pi * first_order.object_index),
            .depth_of_field = first_order.depth_of_field};
}

std::vector<Warning> warnings_of(const PhaseLimits& limits) {
    std::vector<Warning> warnings;
    if (!limits.fills_pupil()) {
        const bool ring = !(limits.source_fill > 0);
        const bool by_source = !ring && limits.source_radius < limits.filling_radius;
        warnings.push_back(
            {.code = "waves-do-not-hold",
             .key = by_source ? "source.radius_mm"
                    : ring    ? "source.elevation_deg"
                              : "specimen.material",
             .value = by_source ? number_text(limits.source_radius) : std::string(),
             .works = by_source ? number_text(limits.filling_radius, Rounding::up)
                      : ring    ? "a ring nearer to the axis, or a specimen that scatters more widely"
                                : "scatter = \"lambertian\", or another that scatters more widely",
             .sentence = fmt::format(
                 "Images of waves do not hold here: light from a point of the specimen is spread unevenly over the "
                 "objective's pupil (the source fills {:.2g} of it, the scatter {:.2g}) and interferes with that of "
                 "its "
                 "neighbours, which vkfv leaves out. Contrasts are up to {:.2g} off, more than {:g}, and heights may "
                 "be off "
                 "by a depth of field, {:.3g} um. Fill the pupil: {}, or take a specimen that scatters more widely.",
                 limits.source_fill, limits.scatter_fill, limits.contrast_error, most_contrast_error,
                 limits.depth_of_field * um_per_mm,
                 limits.source_fill > 0 ? "a larger source.radius_mm" : "a ring light nearer to the axis")});
    }
    if (limits.is_relief_of_phase()) {
        warnings.push_back(
            {.code = "relief-of-phase",
             .key = "specimen.material",
             .value = {},
             .works = "a rougher specimen, or a material that scatters more widely",
             .sentence = fmt::format("Images of waves do not hold here: the specimen is like a mirror (its scatter "
                                     "fills {:.2g} of the objective's "
                                     "aperture), and its texture, {:.3g} um of standard deviation, is below lambda / "
                                     "(4 pi) = {:.3g} um, so that "
                                     "it changes the light's phase alone. Its contrast is wrong, largest out of "
                                     "focus, and heights may be off by "
                                     "a depth of field, {:.3g} um.",
                                     limits.scatter_fill, limits.texture * um_per_mm, limits.phase_height * um_per_mm,
                                     limits.depth_of_field * um_per_mm)});
    }
    return warnings;
}

nlohmann::ordered_json json_of(const PhaseLimits& limits) {
    return {{"contrast_error_fill", limits.contrast_error},
            {"scatter_fill", limits.scatter_fill},
            {"source_fill", limits.source_fill},
            {"texture", limits.texture},
            {"phase_height", limits.phase_height},
            {"hidden_height_uncertainty", limits.height_uncertainty()}};
}

} // namespace vkfv::measurement
