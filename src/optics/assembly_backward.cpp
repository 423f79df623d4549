// The instrument with its light turned round, for paths that start at the detector.
#include "optics/assembly.hpp"

#include "core/units.hpp"
#include "optics/first_order.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace vkfv::optics {

using physics::f64::Surface;

namespace {

constexpr double outside_margin = 1.02; // outlines are searched in finite places: see apertures.cpp
constexpr double inside_margin = 0.99;
constexpr double inside_share =
    0.97; // of the gate on the axis, that the sure gate may shrink to towards the field's edge

// Where the light of an outline's rim lands on the detector, and its slope there.
struct Rim {
    glm::dvec2 position;
    glm::dvec2 slope;
};

std::vector<Rim> rims_at_detector(const Imaging& imaging, const Outline& outline) {
    std::vector<Rim> rims;
    for (std::size_t azimuth = 0; azimuth < outline.radii.size(); ++azimuth) {
        if (outline.radii[azimuth] == 0) {
            continue;
        }
        // Within the rim, which rounding may put on either side of an edge.
        const glm::dvec2 cosines = outline.cosines(azimuth, (1 - 1e-9) * outline.radii[azimuth]);
        physics::f64::Ray ray{};
        ray.position = glm::dvec3(outline.position, -imaging.working_distance);
        ray.direction = glm::dvec3(cosines, std::sqrt(1 - glm::dot(cosines, cosines)));
        const auto traced = trace_through(imaging.train, ray, 1);
        const auto landed = physics::f64::fly_to_plane(traced.ray, imaging.detector_distance, traced.index);
        rims.push_back({glm::dvec2(landed.position), glm::dvec2(landed.direction) / landed.direction.z});
    }
    return rims;
}

// The smallest and the largest |curvature * position + slope| on a cone's rim; the smallest is 0 where some of it is
// dark.
std::pair<double, double> crossings(const Outline& outline, double curvature) {
    double least = std::numeric_limits<double>::infinity();
    double most = 0;
    for (std::size_t azimuth = 0; azimuth < outline.radii.size(); ++azimuth) {
        const glm::dvec2 cosines = outline.cosines(azimuth, outline.radii[azimuth]);
        const glm::dvec2 slope = cosines / std::sqrt(1 - glm::dot(cosines, cosines));
        const double crossing = glm::length(curvature * outline.position + slope);
        least = std::min(least, outline.radii[azimuth] > 0 ? crossing : 0.0);
        most = outline.radii[azimuth] > 0 ? std::max(most, crossing) : most;
    }
    return {least, most};
}

} // namespace

void Assembly::turn_round() {
    TurnedInstrument turned;
    auto& optics = turned.optics;
    constexpr double rounding = 1e-12; // mm
    const PlacedSurface exit_plane = dummy_plane(object_index, front.half_turn(), "front vertex' plane");

    // Detector to specimen.
    Part to_specimen = reversed(imaging_train);
    const Surface to_exit = transfer_between(to_specimen.back().pose, exit_plane);
    if (is_displaced(to_exit) || std::abs(to_exit.distance) > rounding) {
        to_specimen.push_back(exit_plane);
    }
    link(to_specimen, detector_pose.half_turn());

    // Specimen to source, whose outline is the last surface.
    Part to_source = reversed(illumination_train);
    PlacedSurface source = dummy_plane(air, instrument.source_pose.half_turn(), "source");
    source.surface.flags |= physics::f64::SURFACE_CLIPPED;
    source.surface.semi_diameter_squared = description.source_radius * description.source_radius;
    to_source.push_back(source);
    link(to_source, front);

    turned.surfaces = surfaces_of(to_specimen);
    const std::vector<Surface> source_surfaces = surfaces_of(to_source);
    turned.surfaces.insert(turned.surfaces.end(), source_surfaces.begin(), source_surfaces.end());
    turned.constants = constants;
    turned.constants.illumination_count = static_cast<int>(to_specimen.size());
    turned.constants.imaging_first = turned.constants.illumination_count;
    turned.constants.imaging_count = static_cast<int>(to_source.size());

    // The exit pupil: where chief rays at the detector come from, and the widest cone about them.
    const double field_radius = 1.05 * field_half_diagonal;
    glm::dvec2 mean_position(0);
    glm::dvec2 mean_slope(0);
    for (const Rim& rim : rims_at_detector(imaging, outline_at(imaging, {field_half_side, 0}))) {
        mean_position += rim.position;
        mean_slope += rim.slope;
    }
    const double per_position = glm::dot(mean_slope, mean_position) / glm::dot(mean_position, mean_position);
    constexpr int field_points = 12;
    for (const glm::dvec2& direction : search_directions(imaging.symmetric)) {
        for (int i = 0; i <= field_points; ++i) {
            for (const Rim& rim :
                 rims_at_detector(imaging, outline_at(imaging, direction * (field_radius * i / field_points)))) {
                optics.pupil_radius = std::max(optics.pupil_radius,
                                               outside_margin * glm::length(rim.slope - per_position * rim.position));
            }
        }
    }
    // Half a turn about x and light the other way turn (x, y) into (x, -y) and slopes (s, t) into (-s, t): the pupil's
    // crossing, slope - per_position * position, changes its sign alone.
    optics.pupil_position = per_position;

    // The source as the specimen sees it.
    const RayTransfer whole = free_space(first_order.working_distance, object_index.centre)
                                  .then(free_space(source_surfaces.front().distance))
                                  .then(transfer_of_train(source_surfaces));
    optics.source_position = whole.a / (whole.b * object_index.centre);
    optics.object_distance = first_order.working_distance;
    const bool straight =
        std::ranges::none_of(source_surfaces, [](const Surface& surface) { return is_displaced(surface); });
    const Imaging seen = {.train = source_surfaces,
                          .working_distance = first_order.working_distance,
                          .detector_distance = 0,
                          .pupil_curvature = optics.source_position,
                          .symmetric = straight};
    constexpr int fine_field_points = 48;
    const double seen_radius = field_radius + description.greatest_defocus;
    const double on_axis = crossings(outline_at(seen, {0, 0}), optics.source_position).first;
    double inner = on_axis;
    int sure_points = fine_field_points;
    for (const glm::dvec2& direction : search_directions(straight)) {
        for (int i = 0; i <= fine_field_points; ++i) {
            const auto [least, most] =
                crossings(outline_at(seen, direction * (seen_radius * i / fine_field_points)), optics.source_position);
            optics.source_outer = std::max(optics.source_outer, outside_margin * most);
            if (least < inside_share * on_axis) {
                sure_points = std::min(sure_points, i - 1);
            } else if (i <= sure_points) {
                inner = std::min(inner, least);
            }
        }
    }
    // Other wavelengths have other rims, and losses must be traced.
    const bool nothing_sure = !spectrum.monochromatic() || (instrument.features & physics::f64::FEATURE_LOSSES) != 0;
    optics.source_inner = nothing_sure || sure_points < 0 ? 0 : inside_margin * inner;
    optics.inner_field = inside_margin * seen_radius * std::max(sure_points, 0) / fine_field_points;
    instrument.turned = std::move(turned);
}

Instrument turned_round(const Instrument& instrument) {
    Instrument turned = instrument;
    turned.surfaces = instrument.turned.value().surfaces;
    turned.constants = instrument.turned.value().constants;
    turned.surface_names.resize(turned.surfaces.size());
    return turned;
}

} // namespace vkfv::optics
