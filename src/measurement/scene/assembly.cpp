#include "measurement/scene/assembly.hpp"

#include "core/keys/section.hpp"
#include "core/mathematics/units.hpp"
#include "images/image_file.hpp"
#include "measurement/scene/light_field.hpp"
#include "measurement/scene/specimen_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

namespace vkfv::measurement {

namespace {

optics::Instrument assemble_at_its_place(const Configuration& configuration,
                                         optics::InstrumentDescription description) {
    description.light_field = make_light_field(configuration);
    optics::Instrument instrument;
    // The optics' errors have keys, and the configuration knows the places of its keys.
    at_its_place(configuration, {.file = configuration.file}, [&] { instrument = optics::assemble(description); });
    return instrument;
}

// The height over the focus, mm, at which waves of four pixels have half the contrast that they have in focus: half the
// width of focus curves. A disc of light of radius r passes half the contrast of frequency f where 2 pi f r = 2.215.
// wavelength: mm; without one, the image is that of rays.
double defocus_of_half_contrast(const optics::FirstOrder& first_order, std::optional<double> wavelength) {
    constexpr double half_contrast = 2.215, waves_a_pixel = 0.25, greatest_sine = 0.99;
    const double frequency = waves_a_pixel / first_order.pixel_pitch;
    const double sine = std::min(greatest_sine, first_order.numerical_aperture / first_order.object_index);
    const double cosine = std::sqrt(1 - sine * sine);
    if (!wavelength) {
        return half_contrast / (2 * pi * frequency) * cosine / sine;
    }
    // Waves interfere where the pupil overlaps with itself displaced, which is narrower by the share s of the frequency
    // in the cutoff, so that the height is 1 / (1 - s) larger. This height is least at half the cutoff; finer waves,
    // which have little contrast, fade no sooner. The phase of defocus, n z (1 - cos), has the mean slope 2 tan(angle /
    // 2) over the pupil, less than at its rim. The result is within 6 % of Debye's integral at apertures of 0.28 and
    // 0.66.
    const double cutoff = 2 * first_order.numerical_aperture / *wavelength;
    const double seen = std::min(frequency, cutoff / 2);
    return half_contrast / (2 * pi * seen) * (1 + cosine) / (2 * sine) / (1 - seen / cutoff);
}

} // namespace

optics::Instrument assemble_instrument(const Configuration& configuration) {
    return assemble_at_its_place(configuration, configuration.instrument);
}

optics::Instrument assemble_for_figures(const Configuration& configuration) {
    auto description = configuration.instrument;
    description.directed_emission = false;
    return assemble_at_its_place(configuration, std::move(description));
}

std::optional<scan::StageMotion> stage_motion(const Configuration& configuration) {
    if (!configuration.stage) {
        return std::nullopt;
    }
    return scan::StageMotion(*configuration.stage,
                             configuration.scan ? configuration.scan->positions() : std::vector<double>());
}

optics::Instrument assemble_silently(const Configuration& configuration, const specimen::Specimen& specimen,
                                     std::span<const double> focal_heights) {
    auto description = configuration.instrument;
    const auto record = specimen::record_of_geometry(specimen);
    description.greatest_defocus = 0;
    const auto stage = stage_motion(configuration);
    const double astray = stage ? stage->farthest(focal_heights) : 0;
    for (const double focal_height : focal_heights) {
        description.image.greatest_height = std::max(description.image.greatest_height, std::abs(focal_height));
        for (const double height : {record.top, record.bottom}) {
            description.greatest_defocus =
                std::max(description.greatest_defocus, std::abs(height - focal_height) + astray);
        }
    }
    const double lit_radius = std::hypot(std::max(-record.x_min, record.x_max), std::max(-record.y_min, record.y_max));
    if (auto& ring = description.source.ring) {
        ring->lit_radius = lit_radius;
    }
    for (auto& source : description.further_sources) {
        source.ring.value().lit_radius = lit_radius;
    }
    auto instrument = assemble_at_its_place(configuration, std::move(description));
    const auto relief =
        relief_of(specimen, configuration.instrument.detector_pixels, instrument.first_order.pixel_pitch);
    const auto sparse = warning_of_sparse_field(specimen, relief);
    append(instrument.warnings, sparse);
    return instrument;
}

optics::Instrument assemble_instrument(const Configuration& configuration, const specimen::Specimen& specimen,
                                       std::span<const double> focal_heights) {
    auto instrument = assemble_silently(configuration, specimen, focal_heights);
    log_warnings(instrument.warnings);
    return instrument;
}

std::uint32_t image_index(const Configuration& configuration, double focal_height) {
    if (!configuration.scan) {
        return 0;
    }
    const auto positions = configuration.scan->positions();
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (std::abs(positions[i] - focal_height) < 1e-6 * configuration.scan->z_step) {
            return static_cast<std::uint32_t>(i);
        }
    }
    return static_cast<std::uint32_t>(positions.size());
}

optics::Instrument instrument_for(const Configuration& configuration, const specimen::Specimen& specimen,
                                  double focal_height) {
    auto heights = configuration.scan ? configuration.scan->positions() : std::vector<double>();
    if (image_index(configuration, focal_height) == heights.size()) {
        heights.push_back(focal_height);
    }
    return assemble_instrument(configuration, specimen, heights);
}

specimen::Specimen make_specimen(const Configuration& configuration) {
    const auto& description = configuration.specimen.value();
    specimen::Specimen specimen;
    at_its_place(configuration, description.where, [&] { specimen = specimen::make(description); });
    return specimen;
}

std::string image_identity(const Configuration& configuration, const std::string& surface_digest,
                           const trace::TracerIdentity& tracer) {
    return configuration.identity +
           fmt::format("\n[made]\nspecimen_digest = \"{}\"\n{}", surface_digest, tracer.toml());
}

std::optional<optics::Diffraction> make_diffraction(const Configuration& configuration,
                                                    const optics::Instrument& instrument) {
    const auto& options = configuration.diffraction;
    const ImageSize pixels = configuration.instrument.detector_pixels;
    const double pitch = instrument.first_order.pixel_pitch;
    if (options.airy) {
        return optics::Diffraction(
            optics::AiryPattern(instrument.first_order.numerical_aperture, configuration.instrument.spectrum),
            pixels.columns, pixels.rows, pitch);
    }
    if (options.file.empty()) {
        return std::nullopt;
    }
    const Grid<float> point_spread = images::read_image(options.file);
    try {
        return optics::Diffraction(point_spread, options.pitch, pixels.columns, pixels.rows, pitch);
    } catch (const std::invalid_argument& error) {
        throw InputError({configuration.places.at("diffraction.file"), "diffraction.file",
                          fmt::format("{} of {} x {} pixels of {} um", options.file.string(), point_spread.columns,
                                      point_spread.rows, options.pitch * um_per_mm),
                          fmt::format("light whose sum is positive, on pixels of at most {:.4g} um", pitch * um_per_mm),
                          "Correct the file, or the pitch of its pixels in the object plane."});
    }
}

std::optional<optics::Diffraction> diffraction_of_evaluation(const Configuration& configuration,
                                                             const optics::Instrument& instrument) {
    return configuration.camera ? std::nullopt : make_diffraction(configuration, instrument);
}

double focus_curve_deviation(const Configuration& configuration, const optics::FirstOrder& first_order) {
    constexpr double deviations_a_half_width = 1.177;
    std::optional<double> wavelength;
    if (configuration.trace.waves) {
        wavelength = configuration.instrument.spectrum.reference_um * mm_per_um;
    }
    return defocus_of_half_contrast(first_order, wavelength) / deviations_a_half_width;
}

topography::TopographyOptions evaluation_options(const Configuration& configuration,
                                                 const optics::Instrument& instrument) {
    auto options = configuration.topography;
    if (!options.smoothing_steps) {
        const double deviation = focus_curve_deviation(configuration, instrument.first_order);
        const auto positions = configuration.scan->positions();
        const double step = positions.size() > 1 ? positions[1] - positions[0] : deviation;
        options.smoothing_steps = topography::suitable_smoothing(deviation / step, static_cast<int>(positions.size()));
    }
    if (!options.focus_measure) {
        options.focus_measure = !configuration.camera          ? topography::where_texture_is_traced
                                : *options.smoothing_steps > 0 ? topography::where_noise_counts
                                                               : topography::where_little_is_averaged;
    }
    return options;
}

} // namespace vkfv::measurement
