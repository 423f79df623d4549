#include "measurement/instrument/instrument_figures.hpp"

#include "core/mathematics/units.hpp"
#include "core/threads/threads.hpp"
#include "measurement/image/camera_report.hpp"
#include "measurement/judgement/expectation.hpp"
#include "measurement/judgement/plan_warnings.hpp"
#include "measurement/judgement/verdict.hpp"
#include "measurement/scene/assembly.hpp"
#include "measurement/scene/phase_limits.hpp"
#include "measurement/scene/stage_figures.hpp"
#include "measurement/scene/warning_json.hpp"
#include "measurement/scene/wave_limits.hpp"
#include "optics/instrument/image_quality.hpp"
#include "optics/prescriptions/reversal.hpp"
#include "optics/waves/levelled_wavefront.hpp"
#include "trace/device/wave_memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <future>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

namespace vkfv::measurement {

namespace {

// The groups of figures: lenses, pupils, illumination, image, resolution.
std::vector<FigureGroup> groups_of(const Configuration& configuration, const optics::Instrument& instrument,
                                   const optics::ImageQuality& quality) {
    const optics::FirstOrder& first_order = instrument.first_order;
    const auto& source = configuration.instrument.source;
    const bool ring = source.ring.has_value();
    const auto of_disc = [&](double value) { return ring ? NAN : value; };
    return {
        {"Lenses",
         {{"efl_objective_mm", first_order.efl_objective, "focal length of the objective"},
          {"objective_front_principal_plane_mm", quality.objective.front_principal_plane, "behind its front vertex"},
          {"objective_back_principal_plane_mm", quality.objective.back_principal_plane,
           "behind its back vertex; negative: inside"},
          {"efl_tube_lens_mm", first_order.efl_tube_lens, "focal length of the tube lens"},
          {"tube_lens_front_principal_plane_mm", quality.tube_lens.front_principal_plane, "behind its first vertex"},
          {"tube_lens_back_principal_plane_mm", quality.tube_lens.back_principal_plane, "behind its last vertex"},
          {"working_distance_mm", first_order.working_distance, "paraxial object plane to the front vertex"},
          {"free_distance_mm", instrument.front_vertex_height, "plane of best focus to the front vertex"},
          {"best_focus_offset_um", first_order.best_focus_offset * um_per_mm,
           "least wavefront variance over the paraxial plane: z = 0"},
          {"least_spot_offset_um", first_order.least_spot_offset * um_per_mm,
           "on-axis least RMS spot of rays over the paraxial plane"}}},
        {"Pupils",
         {{"numerical_aperture", first_order.numerical_aperture, "object side, on the axis, through all apertures"},
          {"entrance_pupil_height_mm", quality.entrance_pupil_height, "over the object plane; -: telecentric"},
          {"entrance_pupil_radius_mm", quality.entrance_pupil_radius, "as the specimen sees the aperture stop"},
          {"back_pupil_distance_mm", quality.back_pupil_distance, "behind the objective's back vertex"},
          {"back_pupil_radius_mm", quality.back_pupil_radius, "paraxially; what the source's image must fill"},
          {"beam_radius_mm", quality.beam_radius, "of the axial cone behind the objective, traced"},
          {"exit_pupil_distance_mm", quality.exit_pupil_distance, "in front of the detector"},
          {"exit_pupil_radius_mm", quality.exit_pupil_radius, "as the detector sees the aperture stop"}}},
        {"Illumination",
         {{"source_radius_mm", of_disc(source.inner_radius()), "a rectangle's: half its shorter side; -: a ring light"},
          {"pupil_radius_in_source_mm", of_disc(first_order.pupil_radius_in_source),
           "of the source that fills the objective's pupil"},
          {"illumination_to_objective_mm", of_disc(first_order.illumination_to_objective),
           "last vertex of the illumination to the objective's back"},
          {"field_stop_magnification",
           first_order.field_stop_magnification != 0 ? first_order.field_stop_magnification : NAN,
           "of its image on the specimen, paraxial; -: none"}}},
        {"Image",
         {{"magnification", first_order.magnification, "paraxial, at the detector; negative: inverted"},
          {"real_magnification", quality.magnification, "of the light from near the axis, at best focus"},
          {"detector_numerical_aperture", quality.image_aperture, "of the cone that falls on the detector"},
          {"f_number", quality.f_number, "1 / (2 NA) of that cone"},
          {"field_of_view_um", quality.field.x * um_per_mm, "width of what the detector sees"},
          {"field_of_view_height_um", quality.field.y * um_per_mm, "its height"},
          {"field_diagonal_um", quality.field_diagonal * um_per_mm, "its diagonal"},
          {"pixel_pitch_um", first_order.pixel_pitch * um_per_mm, "in the object plane"}}},
        {"Resolution",
         {{"wavelength_um", quality.wavelength_um, "of first-order data; the mean of a spectrum"},
          {"airy_radius_um", quality.airy_radius * um_per_mm, "0.61 lambda / NA, in the object"},
          {"detector_airy_radius_um", quality.detector_airy_radius * um_per_mm, "the same at the detector"},
          {"pixels_per_airy_radius", quality.airy_radius / first_order.pixel_pitch,
           "2 sample all that the optics resolve"},
          {"depth_of_field_um", first_order.depth_of_field * um_per_mm, "n lambda / NA^2"},
          {"detector_depth_of_field_um", quality.detector_depth_of_field * um_per_mm,
           "n pitch / NA, what a pixel adds to it"}}},
    };
}

// The wavefronts at the points of the field that the image quality describes.
struct WavefrontQualities {
    optics::WavefrontQuality axis, edge, corner;
};

WavefrontQualities wavefronts_at(const optics::Instrument& instrument, const optics::ImageQuality& quality) {
    const auto at = [&](const optics::PointImage& point) {
        return std::async(std::launch::async, [&instrument, place = point.position] {
            return optics::wavefront_quality(instrument, place);
        });
    };
    auto axis = at(quality.axis), edge = at(quality.edge), corner = at(quality.corner);
    return {.axis = axis.get(), .edge = edge.get(), .corner = corner.get()};
}

FigureGroup aberrations(const optics::FirstOrder& first_order, const optics::ImageQuality& quality,
                        const WavefrontQualities& wavefront) {
    const double absolute_magnification = std::abs(first_order.magnification);
    const auto in_object_um = [&](double on_detector) { return on_detector / absolute_magnification * um_per_mm; };
    constexpr double percent = 100;
    return {"Aberrations on the axis, at the edge and in the corner of the field, in the plane z = 0",
            {{"field_edge_um", first_order.field_edge * um_per_mm, "height of the edge in the field"},
             {"rms_spot_axis_um", in_object_um(quality.axis.rms_spot), "RMS radius about the centroid, in the object"},
             {"rms_spot_edge_um", in_object_um(quality.edge.rms_spot), "the same at the edge"},
             {"rms_spot_corner_um", in_object_um(quality.corner.rms_spot), "the same in the corner"},
             {"detector_rms_spot_axis_um", quality.axis.rms_spot * um_per_mm, "RMS radius at the detector"},
             {"detector_rms_spot_edge_um", quality.edge.rms_spot * um_per_mm, "the same at the edge"},
             {"detector_rms_spot_corner_um", quality.corner.rms_spot * um_per_mm, "the same in the corner"},
             {"wavefront_rms_axis_waves", wavefront.axis.rms, "RMS, defocus included, tilt removed; mid-spectrum"},
             {"wavefront_rms_edge_waves", wavefront.edge.rms, "the same at the edge"},
             {"wavefront_rms_corner_waves", wavefront.corner.rms, "the same in the corner"},
             {"strehl_axis", wavefront.axis.strehl, "Strehl ratio, over the spectrum; 1: no aberrations"},
             {"strehl_edge", wavefront.edge.strehl, "the same at the edge"},
             {"strehl_corner", wavefront.corner.strehl, "the same in the corner"},
             {"field_curvature_um", first_order.field_curvature * um_per_mm,
              "best focus at the edge over that on the axis"},
             {"field_curvature_corner_um", first_order.field_curvature_corner * um_per_mm, "the same in the corner"},
             {"distortion_edge_percent", quality.edge_distortion * percent, "against the paraxial magnification"},
             {"distortion_corner_percent", quality.corner_distortion * percent, "positive: pincushion"},
             {"relative_light_edge_percent", quality.edge.relative_light * percent, "its cone over that on the axis"},
             {"relative_light_corner_percent", quality.corner.relative_light * percent, "the same in the corner"},
             {"axial_colour_um", quality.axial_colour * um_per_mm, "best focus, 95 % above 5 % point of the spectrum"},
             {"lateral_colour_um", quality.lateral_colour * um_per_mm, "image height at the edge, likewise"}}};
}

FigureGroup figures_of_waves(const optics::WaveOptions& options, const optics::Instrument& instrument,
                             std::vector<Warning>& warnings) {
    constexpr double bytes_per_gib = 1 << 30;
    const auto of_lights = limits_of_lights(options, instrument);
    const WaveLimits limits = worst_of(of_lights);
    append(warnings, warnings_of(limits));
    std::uint64_t memory = 0, memory_of_host = 0; // the light of each source is sorted by itself
    for (const WaveLimits& light : of_lights) {
        const trace::WaveSizes sizes{
            .cells = light.cells, .parts = light.parts, .tiles = light.tiles, .pixels = instrument.detector_pixels()};
        memory += trace::wave_memory(sizes).all();
        memory_of_host += trace::wave_memory_of_host(sizes, core_count()).all();
    }
    const auto error_of = [&](std::size_t point) { return limits.points[point].error.difference; };
    return {"Images as waves make them, within two depths of field",
            {{"wave_cells", static_cast<double>(limits.cells), "across the pupil that light is sorted by"},
             {"wave_tiles", static_cast<double>(limits.tiles), "filters across the field, blended in between"},
             {"wave_parts_per_pixel", static_cast<double>(limits.parts), "of a pixel's side that light is sorted in"},
             {"wave_memory_gib", static_cast<double>(memory) / bytes_per_gib, "that a GPU needs, at most"},
             {"wave_memory_host_gib", static_cast<double>(memory_of_host) / bytes_per_gib,
              "that this machine needs where its processor is the device"},
             {"wave_folded_contrast", limits.folded_contrast, "what waves too fine for the parts are off by"},
             {"wave_contrast_error_axis", error_of(0), "of the pupil's cells against Hopkins' integral"},
             {"wave_contrast_error_edge", error_of(1), "the same at the edge, by its filters"},
             {"wave_contrast_error_corner", error_of(2), "the same in the corner"}}};
}

FigureGroup figures_of_phase(const PhaseLimits& limits, std::vector<Warning>& warnings) {
    append(warnings, warnings_of(limits));
    return {"Whether images of waves hold: a filled pupil, or relief above lambda / (4 pi)",
            {{"wave_contrast_error_fill", limits.contrast_error, "at most, since light does not fill the pupil evenly"},
             {"wave_source_fill", limits.source_fill, "of the objective's aperture, by the source; 0: a ring"},
             {"wave_scatter_fill", limits.scatter_fill, "the same by the specimen's scatter; 0: a mirror"},
             {"wave_texture_um", limits.texture * um_per_mm, "standard deviation of the specimen's texture"},
             {"wave_phase_height_um", limits.phase_height * um_per_mm, "lambda / (4 pi)"}}};
}

FigureGroup figures_of_stage(const Configuration& configuration, std::vector<Warning>& warnings) {
    const auto errors = stage_errors(configuration);
    const auto& stage = *configuration.stage;
    if (stage.exposure_time > stage.interval) {
        warnings.push_back(
            {.code = "exposure-above-interval",
             .key = "stage.interval_s",
             .value = number_text(stage.interval),
             .works = number_text(stage.exposure_time, Rounding::up),
             .sentence = fmt::format("An exposure of {:.4g} s takes longer than the {:.4g} s from image to image. Take "
                                     "a longer stage.interval_s.",
                                     stage.exposure_time, stage.interval)});
    }
    return {"Stage, over the images of the scan",
            {{"stage_position_error_rms_um", errors.rms * um_per_mm, "of the focal plane from its nominal height"},
             {"stage_position_error_largest_um", errors.largest * um_per_mm, "likewise"},
             {"stage_displacement_largest_um", errors.largest_aside * um_per_mm, "of the specimen across the axis"},
             {"stage_exposure_s", stage.exposure_time, "in which vibrations blur; 0: they shift images"}}};
}

FigureGroup figures_of_camera(const camera::Camera& camera) {
    constexpr double decibels = 20, percent = 100;
    const auto& options = camera.options();
    const double given_time = options.control == camera::ExposureControl::time
                                  ? options.exposure_time
                                  : std::numeric_limits<double>::quiet_NaN();
    return {"Camera",
            {{"camera_quantum_efficiency_percent", percent * camera.quantum_efficiency(), "over the source's spectrum"},
             {"camera_electrons_per_joule", camera.electrons_per_joule(), "of light on a pixel"},
             {"camera_exposure_s", given_time, "-: by the light, see camera.exposure"},
             {"camera_full_well_e", options.full_well, "saturation capacity"},
             {"camera_clip_e", camera.clip(), "at which a pixel's charge ends"},
             {"camera_converter_end_e", camera.converter_end(), "at which grey values end"},
             {"camera_gain_dn_per_e", options.gain, "K"},
             {"camera_read_noise_e", options.read_noise, "temporal, in the dark"},
             {"camera_quantisation_noise_e", camera.quantisation_noise(), "of grey values that are whole"},
             {"camera_noise_at_half_e", camera.temporal_noise(options.full_well / 2), "temporal, at half saturation"},
             {"camera_dsnu_e", options.dark_signal, "of the pixels' dark signals"},
             {"camera_prnu_percent", percent * options.photo_response, "of the pixels' responses"},
             {"camera_largest_signal_to_noise_db", decibels * std::log10(camera.largest_signal_to_noise()),
              "of one frame, at saturation"},
             {"camera_dynamic_range_db", decibels * std::log10(camera.dynamic_range()),
              "saturation over the light whose signal to noise ratio is 1"}}};
}

ScanFigures figures_of_scan(const Configuration& configuration) {
    const auto positions = configuration.scan->positions();
    return {.images = positions.size(),
            .rays_per_image = trace::launched_rays(configuration.trace, configuration.instrument),
            .first = positions.front(),
            .last = positions.back()};
}

SpecimenFigures figures_of_specimen(const Configuration& configuration, const optics::Instrument& instrument,
                                    const specimen::Specimen& specimen, std::vector<Warning>& warnings) {
    const auto relief =
        relief_of(specimen, configuration.instrument.detector_pixels, instrument.first_order.pixel_pitch);
    append(warnings, warning_of_sparse_field(specimen, relief));
    const auto [x_min, y_min, x_max, y_max] = specimen::footprint(specimen);
    return {.sides = {x_max - x_min, y_max - y_min}, .relief = relief};
}

void warn_of_size(const SpecimenFigures& specimen, const optics::FirstOrder& first_order,
                  const optics::ImageQuality& quality, std::vector<Warning>& warnings) {
    // A good model has a rim around the field, since light that is scattered there comes into the field too.
    constexpr double most = 2.5;
    for (const int axis : {0, 1}) {
        if (specimen.sides[axis] > most * quality.field[axis] + first_order.pixel_pitch) {
            warnings.push_back(
                {.code = "large-specimen",
                 .key = "specimen.size_mm",
                 .value = number_text(specimen.sides[axis]),
                 .works = number_text(most * quality.field[axis], Rounding::down),
                 .sentence = fmt::format(
                     "The specimen, {:.4g} um across, is {:.2g} times as large as the field of view, {:.4g} "
                     "um: what lies outside is made and not measured.",
                     specimen.sides[axis] * um_per_mm, specimen.sides[axis] / quality.field[axis],
                     quality.field[axis] * um_per_mm)});
            break;
        }
    }
}

// A prescription that is written from infinity towards its focus, as most designs are, makes a valid microscope that
// forms no image. A far better wavefront of the objective turned round tells that it is one. listed: wavefront error of
// the objective as listed, waves RMS on the axis.
void warn_of_direction(const Configuration& configuration, double listed, std::vector<Warning>& warnings) {
    constexpr double suspicious = 0.25; // waves RMS: a Strehl ratio below 0.1
    constexpr double far_better = 0.25; // share of the wavefront error as listed
    if (!(listed > suspicious)) {
        return;
    }
    Configuration other = configuration;
    other.instrument.objective = optics::turned_round(configuration.instrument.objective);
    double turned = 0;
    try {
        turned = optics::wavefront_quality(assemble_for_figures(other), {0, 0}).rms;
    } catch (const std::runtime_error&) { // the turned objective makes no microscope
        return;
    }
    if (turned < far_better * listed) {
        warnings.push_back(
            {.code = "objective-turned-round",
             .key = "objective.prescription",
             .value = configuration.instrument.objective.name,
             .works = "the same turned round, by vkfv import --reverse",
             .sentence = fmt::format(
                 "The objective {} seems to be written from infinity towards its focus: its wavefront on the axis is "
                 "off by "
                 "{:.3g} waves RMS, and by {:.3g} when it is turned round. An objective's prescription begins at the "
                 "specimen "
                 "(vkfv import --reverse)",
                 configuration.instrument.objective.name, listed, turned)});
    }
}

FigureGroup figures_of_expectation(const Configuration& configuration, const Expectation& expected) {
    constexpr double percent = 100;
    FigureGroup group = {
        "Expected of the stack, by a sample of its light",
        {{"expected_height_noise_um", expected.height_noise * um_per_mm, "of a height, by the images' noise"},
         {"expected_height_uncertainty_um", expected.height_uncertainty * um_per_mm,
          "standard uncertainty of a height"},
         {"expected_lateral_resolution_um", expected.lateral_resolution * um_per_mm,
          "period of waves that keep half of their height"},
         {"expected_image_noise_percent", percent * expected.image_noise(), "of a pixel's brightness"},
         {"expected_ray_noise_percent", percent * expected.ray_noise, "of it the rays'"},
         {"expected_texture_percent", percent * expected.texture, "of the brightness, as white texture"},
         {"expected_texture_over_noise", expected.texture_over_noise, "of the focus curves' maxima"},
         {"expected_rays_per_pixel", expected.detected_rays,
          configuration.trace.estimator == trace::Estimator::backward ? "launched, of an image"
                                                                      : "detected, of an image"},
         {"expected_light_per_pixel_W", expected.light_per_pixel, "in focus"},
         {"focus_curve_deviation_um", expected.curve_deviation * um_per_mm, "standard deviation, over the height"},
         {"steepest_slope_deg", expected.steepest / radians_per_degree, "whose light comes back"},
         {"measurable_share_percent", percent * expected.measurable_share, "of the field"},
         {"slopes_to_15_deg_percent", percent * expected.slope_shares[0], "of the points"},
         {"slopes_to_30_deg_percent", percent * expected.slope_shares[1], "from 15 deg on"},
         {"slopes_to_45_deg_percent", percent * expected.slope_shares[2], "from 30 deg on"},
         {"slopes_to_60_deg_percent", percent * expected.slope_shares[3], "from 45 deg on"},
         {"slopes_to_90_deg_percent", percent * expected.slope_shares[4], "from 60 deg on"}}};
    if (configuration.camera) {
        group.figures.push_back(
            {"expected_camera_noise_percent", percent * expected.camera_noise, "of the image's noise the camera's"});
        group.figures.push_back({"expected_light_e", expected.light_electrons, "of a pixel in focus"});
    }
    return group;
}

// The figures of a first look at an instrument; --all prints the others too.
bool matters(const Figure& figure) {
    constexpr std::array names = {"working_distance_mm",
                                  "numerical_aperture",
                                  "magnification",
                                  "field_of_view_um",
                                  "pixel_pitch_um",
                                  "airy_radius_um",
                                  "pixels_per_airy_radius",
                                  "depth_of_field_um",
                                  "strehl_axis",
                                  "strehl_corner",
                                  "field_curvature_corner_um",
                                  "wave_memory_gib",
                                  "wave_contrast_error_fill",
                                  "camera_full_well_e",
                                  "camera_read_noise_e",
                                  "expected_height_noise_um",
                                  "expected_height_uncertainty_um",
                                  "expected_lateral_resolution_um",
                                  "expected_image_noise_percent",
                                  "expected_texture_percent",
                                  "expected_rays_per_pixel"};
    return std::ranges::any_of(names, [&](const char* name) { return std::string_view(name) == figure.name; });
}

// A line of a table with aligned columns: name, value and meaning.
std::string line_of(const char* name, const std::string& value, const std::string& meaning) {
    return fmt::format("  {:<35} {:>12}  {}\n", name, value, meaning);
}

std::string value_text(double value) {
    constexpr double rounding = 1e-12; // in the unit of any figure
    return std::isfinite(value) ? fmt::format("{:.6g}", std::abs(value) < rounding ? 0 : value) : "-";
}

} // namespace

InstrumentFigures instrument_figures(const Configuration& configuration) {
    // Parts that wait for no other have threads of their own, since every command of a new instrument begins here.
    std::future<specimen::Specimen> specimen;
    if (configuration.specimen) {
        specimen = std::async(std::launch::async, [&] { return make_specimen(configuration); });
    }
    const auto instrument = assemble_for_figures(configuration);
    const auto& first_order = instrument.first_order;
    auto measured =
        std::async(std::launch::async, [&] { return optics::image_quality(configuration.instrument, instrument); });
    std::vector<Warning> warnings_of_waves;
    std::optional<FigureGroup> waves;
    if (configuration.trace.waves) {
        waves = figures_of_waves(*configuration.trace.waves, instrument, warnings_of_waves);
    }
    const auto quality = measured.get();
    InstrumentFigures figures{.groups = groups_of(configuration, instrument, quality),
                              .scan = {},
                              .specimen = {},
                              .verdict = {},
                              .warnings = instrument.warnings};
    const WavefrontQualities wavefront = wavefronts_at(instrument, quality);
    figures.groups.push_back(aberrations(first_order, quality, wavefront));
    auto& warnings = figures.warnings;
    append(warnings, quality.warnings);
    warn_of_direction(configuration, wavefront.axis.rms, warnings);
    if (waves) {
        figures.groups.push_back(*std::move(waves));
        append(warnings, warnings_of_waves);
    }
    if (configuration.camera) {
        const camera::Camera camera(*configuration.camera, configuration.instrument.spectrum);
        figures.groups.push_back(figures_of_camera(camera));
        append(warnings, warnings_of(camera));
    }
    if (configuration.stage && configuration.scan) {
        figures.groups.push_back(figures_of_stage(configuration, warnings));
    }
    if (configuration.scan) {
        figures.scan = figures_of_scan(configuration);
    }
    std::optional<Expectation> expected;
    if (configuration.specimen) {
        const specimen::Specimen made = specimen.get();
        figures.specimen = figures_of_specimen(configuration, instrument, made, warnings);
        double hidden_uncertainty = 0;
        if (configuration.trace.waves) {
            const PhaseLimits limits = phase_limits(configuration.instrument, instrument, made);
            hidden_uncertainty = limits.height_uncertainty();
            figures.groups.push_back(figures_of_phase(limits, warnings));
        }
        warn_of_size(*figures.specimen, first_order, quality, warnings);
        append(warnings, plan_warnings(configuration, instrument, figures.specimen->relief));
        if (configuration.scan && figures.specimen->relief.seen_share > 0) {
            expected = expect(configuration, instrument, made, hidden_uncertainty);
            append(warnings, warnings_of(configuration, *expected));
            figures.groups.push_back(figures_of_expectation(configuration, *expected));
        }
    } else {
        append(warnings, plan_warnings(configuration, instrument, {}));
    }
    figures.verdict = verdict_on(configuration, instrument, expected, warnings);
    return figures;
}

nlohmann::ordered_json instrument_json(const InstrumentFigures& figures, const std::filesystem::path& file) {
    nlohmann::ordered_json report;
    report["configuration"] = file.string();
    for (const auto& group : figures.groups) {
        for (const auto& figure : group.figures) {
            report[figure.name] = figure.value;
        }
    }
    if (const auto& scan = figures.scan) {
        report["images"] = scan->images;
        report["rays_per_image"] = scan->rays_per_image;
    }
    if (const auto& specimen = figures.specimen) {
        const auto& relief = specimen->relief;
        report["specimen_seen_share"] = relief.seen_share;
        report["specimen_side_um"] = std::max(specimen->sides.x, specimen->sides.y) * um_per_mm;
        if (relief.seen_share > 0) {
            report["specimen_lowest_um"] = relief.lowest * um_per_mm;
            report["specimen_highest_um"] = relief.highest * um_per_mm;
        }
    }
    report["verdict"] = json_of(figures.verdict);
    report["warnings"] = json_of(figures.warnings);
    return report;
}

std::string instrument_text(const InstrumentFigures& figures, bool all) {
    std::string text;
    for (const auto& group : figures.groups) {
        std::string lines;
        for (const auto& figure : group.figures) {
            if (all || matters(figure)) {
                lines += line_of(figure.name, value_text(figure.value), figure.meaning);
            }
        }
        text += lines.empty() ? "" : fmt::format("{}\n{}", group.title, lines);
    }
    if (figures.scan || figures.specimen) {
        text += "Exposures\n";
    }
    if (const auto& scan = figures.scan) {
        text += line_of("images", std::to_string(scan->images),
                        fmt::format("z from {:g} to {:g} um, {:.3g} rays each", scan->first * um_per_mm,
                                    scan->last * um_per_mm, static_cast<double>(scan->rays_per_image)));
    }
    if (const auto& specimen = figures.specimen) {
        const auto& relief = specimen->relief;
        text += line_of("specimen_side_um", value_text(std::max(specimen->sides.x, specimen->sides.y) * um_per_mm),
                        "the longer side of its footprint");
        if (relief.seen_share > 0) {
            text += line_of("specimen_lowest_um", value_text(relief.lowest * um_per_mm),
                            fmt::format("highest {:.6g} um, on {:.1f} % of the field", relief.highest * um_per_mm,
                                        100 * relief.seen_share));
        }
    }
    return text;
}

} // namespace vkfv::measurement
