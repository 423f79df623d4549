#include "optics/instrument/image_quality.hpp"

#include "core/mathematics/units.hpp"
#include "core/threads/parallel_list.hpp"
#include "optics/aim/best_focus.hpp"
#include "optics/train/first_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <future>

namespace vkfv::optics {

namespace {

using physics::f64::PATH_ALIVE;
using physics::f64::Ray;
using physics::f64::real3;
using physics::f64::Surface;

constexpr double airy_factor = 0.6098350; // first zero of J1 over 2 pi

// The share of the rim from which an edge other than the stop's counts as clipping; smaller shares are rounding of
// tables.
constexpr double least_clipped_share = 0.02;
// Corners darker than this are reported with the lenses that clip them; assemble() warns of them at the same limit.
constexpr double least_relative_light = 0.9;

// A ray's position on the detector (mm), and its share of the light.
struct Arrival {
    glm::dvec2 position;
    double weight = 0;
};

Ray ray_from(const Imaging& imaging, glm::dvec2 position, double height, glm::dvec2 cosines) {
    Ray ray{};
    ray.position = real3(position, height - imaging.working_distance);
    ray.direction = real3(cosines, std::sqrt(std::max(0.0, 1 - glm::dot(cosines, cosines))));
    return ray;
}

// The rays of the cone that arrive, their weights normalized to 1. Apertures are not traced, as the outline already
// respects them.
std::vector<Arrival> arrivals(const Imaging& imaging, const Outline& outline, const std::vector<ConeRay>& cone,
                              double height) {
    std::vector<Arrival> list;
    double total = 0;
    for (const auto& [cosines, weight] : cone) {
        const auto result = trace_through(imaging.train, ray_from(imaging, outline.position, height, cosines), 0);
        if (result.status != PATH_ALIVE) {
            continue;
        }
        const Ray landed = physics::f64::fly_to_plane(result.ray, imaging.detector_distance, result.index);
        list.push_back({.position = {landed.position.x, landed.position.y}, .weight = weight});
        total += weight;
    }
    for (Arrival& arrival : list) {
        arrival.weight /= total;
    }
    return list;
}

// The number of equal shares of the cone, each with the eight rings of fill_cone().
constexpr int cone_panels = 3;

CardinalPoints cardinal_points(const Prescription& prescription, const Spectrum& spectrum) {
    Pose end;
    auto part = place_prescription(prescription, spectrum, {}, Pose{}, end);
    link(part, part.front().pose);
    const auto surfaces = surfaces_of(part);
    const RayTransfer transfer = transfer_of_train(surfaces);
    const PrincipalPlanes planes =
        principal_planes(transfer, surfaces.front().index_before, surfaces.back().index_after);
    return {.focal_length = focal_length(transfer),
            .front_principal_plane = planes.front,
            .back_principal_plane = planes.back};
}

// The edges that stop the rays just outside the rim, with their shares of the rim, the largest first.
std::vector<Clipping> clipping(const Imaging& imaging, const Outline& outline, const Instrument& instrument,
                               std::size_t aperture_stop) {
    // A relative step and one in cosines: beyond the rim's bisection error, short of any other edge.
    constexpr double outside = 1e-6;
    std::vector<Clipping> list;
    for (std::size_t azimuth = 0; azimuth < outline.radii.size(); ++azimuth) {
        const glm::dvec2 cosines = outline.cosines(azimuth, outline.radii[azimuth] * (1 + outside) + outside);
        if (glm::dot(cosines, cosines) >= 1) {
            continue;
        }
        const auto result = trace_through(imaging.train, ray_from(imaging, outline.position, 0, cosines), 1);
        if (result.surface < 0) {
            continue;
        }
        const auto surface = static_cast<std::size_t>(result.surface);
        const std::string& name =
            instrument.surface_names[static_cast<std::size_t>(instrument.constants.imaging_first) + surface];
        auto found = std::ranges::find(list, name, &Clipping::surface);
        if (found == list.end()) {
            list.push_back({.surface = name, .share = 0, .aperture_stop = surface == aperture_stop});
            found = list.end() - 1;
        }
        found->share += 1.0 / static_cast<double>(outline.radii.size());
    }
    std::ranges::stable_sort(list, std::ranges::greater{}, &Clipping::share);
    return list;
}

std::string list_of_lenses(const std::vector<Clipping>& clipping) {
    std::string text;
    for (const Clipping& edge : clipping) {
        if (!edge.aperture_stop && edge.share >= least_clipped_share) {
            text += fmt::format("{}{} ({:.0f} % of the rim)", text.empty() ? "" : ", ", edge.surface, 100 * edge.share);
        }
    }
    return text;
}

} // namespace

std::vector<SpectralNode> spectral_nodes(const Instrument& instrument, int fewest) {
    return spectral_nodes(instrument.spectral_bins, instrument.constants.spectrum_centre,
                          instrument.constants.spectrum_half_width, fewest);
}

Imaging imaging_of(const Instrument& instrument) {
    const auto& constants = instrument.constants;
    const auto first = instrument.surfaces.begin() + constants.imaging_first;
    Imaging imaging;
    imaging.train = {first, first + constants.imaging_count};
    imaging.working_distance = instrument.first_order.working_distance;
    imaging.detector_distance = constants.detector_distance;
    imaging.pupil_curvature = constants.gate_position;
    imaging.symmetric = std::ranges::none_of(imaging.train, is_displaced);
    imaging.detector_index = imaging.train.back().index_after;
    return imaging;
}

PointImage point_image(const Imaging& imaging, const Outline& outline, double height,
                       std::span<const SpectralNode> spectrum) {
    PointImage image{.position = outline.position};
    if (!(outline.area() > 0)) { // without light no figure is defined
        image.centroid = glm::dvec2(NAN);
        image.rms_spot = NAN;
        return image;
    }
    const auto cone = fill_cone(outline, cone_panels);
    auto light = parallel_list(static_cast<int>(spectrum.size()), [&](int node) {
        return arrivals(at_wavelength(imaging, spectrum[static_cast<std::size_t>(node)].spectral), outline, cone,
                        height);
    });
    for (std::size_t node = 0; node < light.size(); ++node) {
        for (const Arrival& ray : light[node]) {
            image.centroid += spectrum[node].weight * ray.weight * ray.position;
        }
    }

    double mean_square = 0;
    for (std::size_t node = 0; node < light.size(); ++node) {
        for (const Arrival& ray : light[node]) {
            const glm::dvec2 deviation = ray.position - image.centroid;
            mean_square += spectrum[node].weight * ray.weight * glm::dot(deviation, deviation);
        }
    }
    image.rms_spot = std::sqrt(mean_square);
    return image;
}

namespace {

// The optics and reference data that all figures share.
struct Setting {
    const InstrumentDescription& description;
    const Instrument& instrument;
    Imaging imaging;
    std::vector<SpectralNode> nodes;     // nodes of the spectrum
    std::vector<SpectralNode> reference; // the reference wavelength alone
    std::size_t stop = 0;                // index of the stop in the imaging train
    std::size_t objective_end = 0;       // index in the imaging train, behind the objective
    double height = 0;                   // mm, height of the plane of best focus
    Outline on_axis{};
};

Setting setting_of(const InstrumentDescription& description, const Instrument& instrument) {
    const auto& constants = instrument.constants;
    Setting setting{
        .description = description,
        .instrument = instrument,
        .imaging = imaging_of(instrument),
        .nodes = spectral_nodes(description.spectrum.bins, constants.spectrum_centre, constants.spectrum_half_width),
        .reference = {{.spectral = 0, .wavelength_um = 1 / std::sqrt(constants.spectrum_centre), .weight = 1}}};
    std::ranges::stable_sort(setting.nodes, {}, &SpectralNode::wavelength_um); // spectra of several sources overlap
    // The cover glass' two surfaces stand before the objective's.
    const auto& objective = description.objective.surfaces;
    const std::size_t objective_first = description.cover_glass ? 2 : 0;
    const auto marked = std::ranges::find(objective, SurfaceRole::aperture_stop, &PrescribedSurface::role);
    setting.stop = objective_first + static_cast<std::size_t>(marked - objective.begin());
    setting.objective_end = objective_first + objective.size();
    setting.height = instrument.first_order.best_focus_offset;
    setting.on_axis = outline_at(setting.imaging, {0, 0});
    return setting;
}

// Finds the paraxial pupils.
void find_pupils(ImageQuality& quality, const Setting& setting) {
    const Imaging& imaging = setting.imaging;
    const std::span<const Surface> train = imaging.train;
    const std::size_t stop = setting.stop;
    const double stop_radius = std::sqrt(train[stop].semi_diameter_squared);
    const double object_index = setting.instrument.first_order.object_index;
    const StopImage entrance = stop_seen_from_front(
        free_space(imaging.working_distance, object_index).then(transfer_to_surface(train, stop)), object_index);
    quality.entrance_pupil_height = entrance.distance;
    quality.entrance_pupil_radius = stop_radius * std::abs(entrance.magnification);
    const StopImage back = stop_seen_from_behind(transfer_of_train(train.subspan(stop, setting.objective_end - stop)));
    quality.back_pupil_distance = back.distance;
    quality.back_pupil_radius = stop_radius * std::abs(back.magnification);
    const StopImage exit = stop_seen_from_behind(transfer_of_train(train.subspan(stop)), imaging.detector_index);
    quality.exit_pupil_distance = imaging.detector_distance - exit.distance;
    quality.exit_pupil_radius = stop_radius * std::abs(exit.magnification);
}

// Measures the aperture and the beam of the cone from the axis in the paraxial object plane, by its rim.
void measure_axial_cone(ImageQuality& quality, const Setting& setting) {
    const std::span<const Surface> train = setting.imaging.train;
    const Outline& on_axis = setting.on_axis;
    const double rim_rays = static_cast<double>(on_axis.radii.size());
    double sine_square = 0;
    double height_square = 0;
    glm::dvec2 beam_centre(0);
    glm::dvec2 cone_centre(0); // nonzero with a tilted detector
    for (std::size_t azimuth = 0; azimuth < on_axis.radii.size(); ++azimuth) {
        const Ray rim = ray_from(setting.imaging, {0, 0}, 0, on_axis.cosines(azimuth, on_axis.radii[azimuth]));
        const glm::dvec3 direction = trace_through(train, rim, 0).ray.direction;
        const glm::dvec3 behind = trace_through(train.first(setting.objective_end), rim, 0).ray.position;
        sine_square += (direction.x * direction.x + direction.y * direction.y) / rim_rays;
        height_square += (behind.x * behind.x + behind.y * behind.y) / rim_rays;
        beam_centre += glm::dvec2(behind.x, behind.y) / rim_rays;
        cone_centre += glm::dvec2(direction.x, direction.y) / rim_rays;
    }
    quality.image_aperture = std::sqrt(sine_square - glm::dot(cone_centre, cone_centre));
    quality.beam_radius = std::sqrt(height_square - glm::dot(beam_centre, beam_centre));
    quality.f_number = 0.5 / quality.image_aperture;
}

// The signed magnification of centroids at the reference wavelength, relative to the axial centroid `origin`.
double real_magnification(const Setting& setting, const Imaging& imaging, const Outline& outline, glm::dvec2 origin) {
    const glm::dvec2 way = point_image(imaging, outline, setting.height, setting.reference).centroid - origin;
    return glm::dot(way, outline.position) / glm::dot(outline.position, outline.position);
}

struct Worst {
    PointImage image;
    Outline outline;
    double distortion = 0; // relative excess of the image's distance over magnification times the object's
};

// The image of largest spot among the points.
Worst worst_of(const Setting& setting, const std::vector<glm::dvec2>& points, glm::dvec2 axis_centroid) {
    const Imaging& imaging = setting.imaging;
    const auto all = parallel_list(static_cast<int>(points.size()), [&](int k) {
        const Outline outline = outline_at(imaging, points[static_cast<std::size_t>(k)]);
        PointImage image = point_image(imaging, outline, setting.height, setting.nodes);
        image.relative_light = outline.area() / setting.on_axis.area();
        const double magnification = real_magnification(setting, imaging, outline, axis_centroid);
        const glm::dvec2 arrived = magnification * outline.position;
        const glm::dvec2 recorded = physics::f64::recorded_place(setting.instrument.constants, {}, arrived);
        const glm::dvec2 paraxial = setting.instrument.first_order.magnification * outline.position;
        return Worst{image, outline, glm::length(recorded) / glm::length(paraxial) - 1};
    });
    Worst worst = all.front();
    for (const Worst& one : all) {
        worst = one.image.rms_spot > worst.image.rms_spot ? one : worst;
    }
    return worst;
}

void measure_colour(ImageQuality& quality, const Setting& setting, const Outline& edge) {
    const FirstOrder& first_order = setting.instrument.first_order;
    const TrainScene scene = setting.instrument.scene();
    struct Colour {
        double focus;
        double height; // height of the edge's image on the detector, mm
    };
    const auto at_share = [&](double share) {
        const double spectral = physics::f64::draw_light(scene, setting.instrument.constants, share).spectral;
        const Imaging tinted = at_wavelength(setting.imaging, spectral);
        const std::array node = {SpectralNode{.spectral = spectral, .wavelength_um = 1, .weight = 1}};
        const glm::dvec2 origin = point_image(tinted, setting.on_axis, setting.height, setting.reference).centroid;
        return Colour{.focus = best_focus(setting.imaging, first_order.magnification, setting.on_axis, node),
                      .height = real_magnification(setting, tinted, edge, origin) * first_order.field_edge};
    };
    const Colour shorter = at_share(0.05);
    const Colour longer = at_share(0.95);
    quality.axial_colour = longer.focus - shorter.focus;
    quality.lateral_colour = (longer.height - shorter.height) / first_order.magnification;
}

// Warnings about lenses that clip the light, and pixels that do not suit the optics.
std::vector<Warning> warnings_of(const ImageQuality& quality, const InstrumentDescription& description,
                                 const FirstOrder& first_order) {
    std::vector<Warning> warnings;
    if (const std::string lenses = list_of_lenses(quality.axis_clipping); !lenses.empty()) {
        warnings.push_back(
            {.code = "clipped-axis",
             .key = "objective.aperture_stop_radius_mm",
             .value = description.aperture_stop_radius ? number_text(*description.aperture_stop_radius) : std::string(),
             .works = "a smaller stop, or lenses with larger semi_diameter_mm",
             .sentence = "The cone on the axis is not limited by the aperture stop alone: " + lenses + "."});
    }
    if (quality.corner.relative_light < least_relative_light) {
        if (const std::string lenses = list_of_lenses(quality.corner_clipping); !lenses.empty()) {
            warnings.push_back({.code = "clipped-corner",
                                .key = "detector.size_mm",
                                .value = number_text(description.detector_width),
                                .works = "a smaller detector, or lenses with larger semi_diameter_mm",
                                .sentence = "The cone from the field's corner is clipped by " + lenses + "."});
        }
    }
    // Where one pixel's blur, n e / NA, exceeds the depth of field n lambda / NA^2, the detector, being coarser than
    // the optics, determines the depth of field. Full sampling takes half an Airy radius, which focus variation can do
    // without. Below a tenth of the radius pixels add noise and memory but no detail.
    constexpr double far_finer = 0.1;
    const ImageSize pixels = description.detector_pixels;
    const auto pixels_of_pitch = [&](double pitch) {
        const double times = first_order.pixel_pitch / pitch;
        return text_of(ImageSize{.columns = std::max(1, static_cast<int>(std::lround(pixels.columns * times))),
                                 .rows = std::max(1, static_cast<int>(std::lround(pixels.rows * times)))});
    };
    if (quality.detector_depth_of_field > first_order.depth_of_field) {
        const double wavelength = quality.wavelength_um * mm_per_um;
        warnings.push_back(
            {.code = "coarse-pixels",
             .key = "detector.pixels",
             .value = text_of(pixels),
             .works = pixels_of_pitch(0.5 * quality.airy_radius),
             .sentence = fmt::format(
                 "The detector's pixel, {:.3g} um in the object, is coarser than the optics: above lambda / NA "
                 "= {:.3g} um it decides the depth of field; sampling all that they resolve takes {:.3g} um.",
                 first_order.pixel_pitch * um_per_mm, wavelength / first_order.numerical_aperture * um_per_mm,
                 0.5 * quality.airy_radius * um_per_mm)});
    } else if (first_order.pixel_pitch < far_finer * quality.airy_radius) {
        warnings.push_back(
            {.code = "fine-pixels",
             .key = "detector.pixels",
             .value = text_of(pixels),
             .works = pixels_of_pitch(0.5 * quality.airy_radius),
             .sentence = fmt::format(
                 "The detector's pixel, {:.3g} um in the object, is far finer than the optics resolve, whose Airy "
                 "radius is {:.3g} um: larger pixels would see as much, with less noise.",
                 first_order.pixel_pitch * um_per_mm, quality.airy_radius * um_per_mm)});
    }
    return warnings;
}

} // namespace

ImageQuality image_quality(const InstrumentDescription& description, const Instrument& instrument) {
    const FirstOrder& first_order = instrument.first_order;
    const Setting setting = setting_of(description, instrument);
    const Imaging& imaging = setting.imaging;
    ImageQuality quality;
    quality.wavelength_um = setting.reference.front().wavelength_um;

    Prescription objective = description.objective;
    objective.medium_before = description.immersion.value_or(objective.medium_before);
    quality.objective = cardinal_points(objective, description.spectrum);
    quality.tube_lens = cardinal_points(description.tube_lens, description.spectrum);
    find_pupils(quality, setting);

    const double wavelength = quality.wavelength_um * mm_per_um;
    quality.airy_radius = airy_factor * wavelength / first_order.numerical_aperture;
    quality.detector_airy_radius = quality.airy_radius * std::abs(first_order.magnification);
    quality.detector_depth_of_field =
        first_order.object_index * first_order.pixel_pitch / first_order.numerical_aperture;
    quality.field = 2.0 * first_order.field_corner;
    quality.field_diagonal = glm::length(quality.field);

    measure_axial_cone(quality, setting);
    quality.axis = point_image(imaging, setting.on_axis, setting.height, setting.nodes);
    quality.axis.relative_light = 1;
    const glm::dvec2 axis_centroid = point_image(imaging, setting.on_axis, setting.height, setting.reference).centroid;
    const double near_axis = 0.01 * first_order.field_edge; // the distortion here is 1e-4 of the edge's
    quality.magnification = real_magnification(setting, imaging, outline_at(imaging, {near_axis, 0}), axis_centroid);

    const glm::dvec2 far = first_order.field_corner;
    std::vector<glm::dvec2> edges = {{first_order.field_edge, 0}};
    std::vector<glm::dvec2> corners = {{glm::length(far), 0}};
    if (!imaging.symmetric) {
        edges = {{far.x, 0}, {0, far.y}, {-far.x, 0}, {0, -far.y}};
        corners = {far, {-far.x, far.y}, -far, {far.x, -far.y}};
    }
    auto at_edge = std::async(std::launch::async, [&] { return worst_of(setting, edges, axis_centroid); });
    const Worst corner = worst_of(setting, corners, axis_centroid);
    const Worst edge = at_edge.get();
    quality.edge = edge.image;
    quality.edge_distortion = edge.distortion;
    quality.corner = corner.image;
    quality.corner_distortion = corner.distortion;
    if (!description.spectrum.monochromatic()) {
        measure_colour(quality, setting, edge.outline);
    }
    quality.axis_clipping = clipping(imaging, setting.on_axis, instrument, setting.stop);
    quality.corner_clipping = clipping(imaging, corner.outline, instrument, setting.stop);
    quality.warnings = warnings_of(quality, description, first_order);
    return quality;
}

} // namespace vkfv::optics
