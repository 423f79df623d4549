#include "optics/assembly.hpp"

#include "core/units.hpp"
#include "optics/emission_cone.hpp"
#include "optics/first_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace vkfv::optics {

using physics::f64::Surface;
using Role = PrescribedSurface::Role;

namespace {

// A whole part moved: what was given against `from` then stands the same way against `to`.
void move(Part& part, const Pose& from, const Pose& to) {
    const glm::dmat3 turn = to.axes * glm::transpose(from.axes);
    for (PlacedSurface& placed : part) {
        placed.pose = {to.origin + turn * (placed.pose.origin - from.origin), turn * placed.pose.axes};
    }
}

} // namespace

// From any point of the band the ball about what is lit lies within this cone about the band's normal: its middle is
// off the normal by at most the half width, and no point of the ball is nearer than this. A cover glass moves light
// sideways, by less than its thickness if it is the denser medium; else near total reflection by any length, and then
// all light is kept.
double Assembly::ring_emission_sine() const {
    const RingLightDescription& ring = *description.ring;
    constexpr double margin = 1.5; // around the detector's field
    const double lit_radius =
        std::hypot(ring.lit_radius.value_or(margin * field_half_diagonal), description.greatest_defocus);
    const double nearest = ring.distance - lit_radius;
    const double aside = lit_radius + 0.5 * ring.width;
    const double shift = cover.empty() ? 0 : description.cover_glass->thickness;
    const auto is_rarer_at = [&](double wavelength_um) {
        return description.cover_glass->glass.index(wavelength_um) < objective_lens.medium_before.index(wavelength_um);
    };
    const bool may_reflect_totally =
        !cover.empty() && (is_rarer_at(spectrum.shortest_um) || is_rarer_at(spectrum.longest_um));
    const double distance = std::hypot(nearest, aside);
    if (may_reflect_totally || !(nearest > 0 && shift < distance)) {
        return 1;
    }
    // The line of the light passes what it lights at the distance `shift`.
    const double angle = std::atan2(aside, nearest) + std::asin(shift / distance);
    return angle < 0.5 * pi ? std::sin(angle) : 1;
}

void Assembly::assemble_ring() {
    const RingLightDescription& ring = *description.ring;
    illumination_train = reversed(cover);
    const Pose entry = illumination_train.empty() ? front.half_turn() : illumination_train.front().pose;
    link(illumination_train, entry);
    constants.ring.aim_distance = entry.origin.z - first_order.best_focus_offset;
    constants.ring.distance = ring.distance;
    constants.ring.elevation_sine = std::sin(ring.elevation);
    constants.ring.elevation_cosine = std::cos(ring.elevation);
    constants.ring.half_width = 0.5 * ring.width;
    constants.ring.fill = ring.fill;
    constants.ring.segments = ring.segments;
    for (std::size_t segment = 0; segment < ring.on.size(); ++segment) {
        constants.ring.switched_on |= ring.on[segment] ? 1u << segment : 0u;
    }
    if (ring.segments < 1 || ring.segments > physics::f64::RING_CAPACITY ||
        ring.on.size() != static_cast<std::size_t>(ring.segments) || constants.ring.switched_on == 0) {
        refuse("source.segments", fmt::format("{} segments", ring.segments),
               fmt::format("1 to {} segments, at least one of them on", physics::f64::RING_CAPACITY),
               "Switch a segment on.");
    }
    if (!(ring.distance > 0 && ring.width > 0 && ring.elevation > 0 && ring.elevation < 0.5 * pi &&
          0.5 * ring.width * std::tan(ring.elevation) < ring.distance)) {
        refuse("source.width_mm", fmt::format("{} mm wide, {} mm away", ring.width, ring.distance),
               "a band that does not reach the axis", "Choose a smaller width or elevation.");
    }
    if (!cover.empty() &&
        !(ring.distance * constants.ring.elevation_sine - constants.ring.half_width * constants.ring.elevation_cosine >
          constants.ring.aim_distance)) {
        refuse("source.distance_mm", fmt::format("{} mm", ring.distance),
               fmt::format("a ring above the cover glass, whose upper face is {:.6g} mm over the focus",
                           constants.ring.aim_distance),
               "Move the ring farther away, or the cover glass nearer to the specimen.");
    }
    aimed_sine = ring_emission_sine();
    instrument.source_pose = downward(0);
    instrument.features |= physics::f64::FEATURE_RING;
}

void Assembly::assemble_illuminator() {
    require_surfaces(description.illumination, "illumination.prescription");
    const Prescription prescribed = with_stop(description.illumination, Role::field_stop, description.field_stop_radius,
                                              "illumination.field_stop_radius_mm");
    Pose end;
    illuminator = place_prescription(prescribed, spectrum, description.interfaces, Pose{}, end);
    require_air(illuminator.front().surface.index_before, prescribed, "illumination.prescription");
    require_air(illuminator.back().surface.index_after, prescribed, "illumination.prescription");
    const RayTransfer illuminator_transfer = transfer_of(illuminator);

    // The source is imaged into the objective's pupil, as it is seen from the back.
    const std::optional<double> source_distance =
        description.source_distance ? description.source_distance : prescribed.source_distance;
    if (!source_distance || !(*source_distance >= 0)) {
        refuse("source.distance_mm", source_distance ? fmt::format("{}", *source_distance) : "",
               "the distance from the source to the illuminator, >= 0",
               "Give it, or source_distance_mm in the prescription.", prescribed.file);
    }
    constants.source_distance = *source_distance;
    const ParaxialImage source_image = image_of(illuminator_transfer, *source_distance);
    Part straight_backward = reversed(straight_objective);
    link(straight_backward, straight_backward.front().pose);
    const std::size_t stop_backward = objective.size() - 1 - *aperture_stop;
    const RayTransfer back_to_stop = transfer_to_surface(surfaces_of(straight_backward), stop_backward);
    const EntrancePupil back_pupil = entrance_pupil(back_to_stop);
    const double stop_radius = std::sqrt(objective[*aperture_stop].surface.semi_diameter_squared);
    // The stop's image has 1 / a its size; a = 0 has none. What stands on the vertex is no further away than
    // 0.
    const double back_pupil_distance = back_to_stop.b == 0 ? 0 : 1 / back_pupil.curvature;
    const double back_pupil_radius = stop_radius / std::abs(back_to_stop.a);
    // The cube's glass makes the way longer.
    const double glass_shift = splitter.kind == BeamSplitter::Kind::cube
                                   ? splitter.size * (1 - 1 / splitter.glass.index(spectrum.reference_um))
                                   : 0;
    first_order.illumination_to_objective =
        description.illumination_to_objective.value_or(source_image.distance - back_pupil_distance + glass_shift);
    const double distance = first_order.illumination_to_objective;
    if (!(distance >= 0 && std::isfinite(distance))) {
        refuse("illumination.objective_distance_mm", fmt::format("{:.6g}", distance),
               fmt::format("room between {} and {} so that the source is imaged into the pupil", prescribed.name,
                           description.objective.name),
               "Give a distance >= 0, or move the source nearer to the illuminator's focal plane.", prescribed.file);
    }
    first_order.source_magnification = source_image.magnification;
    first_order.pupil_radius_in_source = back_pupil_radius / std::abs(source_image.magnification);
    const double filling_radius = std::min(
        description.source_radius, description.illumination_aperture_radius.value_or(description.source_radius));
    if (filling_radius < 0.98 * first_order.pupil_radius_in_source) {
        instrument.warnings.push_back(
            fmt::format("The source does not fill the objective's pupil: its radius is {:.4g} mm, filling takes "
                        "{:.4g} mm.",
                        filling_radius, first_order.pupil_radius_in_source));
    }
    const double image_to_pupil = distance + back_pupil_distance - glass_shift - source_image.distance;
    if (!(std::abs(image_to_pupil) < 0.05 * first_order.efl_objective)) {
        instrument.warnings.push_back(fmt::format(
            "The source is imaged {:.3g} mm in front of the objective's pupil instead of into it.", image_to_pupil));
    }

    const Pose illuminator_last = downward(back + distance);
    move(illuminator, end, illuminator_last);
    const Pose entry = {illuminator_last.origin - illuminator_last.axes * (glm::transpose(end.axes) * end.origin),
                        illuminator_last.axes * glm::transpose(end.axes)};
    std::vector<Inserted> between;
    if (splitter.kind == BeamSplitter::Kind::cube) {
        between.push_back({distance - splitter_distance,
                           plate(downward(splitter_height + half_size), splitter.size, splitter.glass, Medium::air(),
                                 splitter.semi_diameter.value_or(half_size), "beam splitter")});
    }
    const double splitter_from_illuminator = distance - splitter_distance;
    for (const FoldMirror& fold : description.fold_mirrors) {
        if (fold.path == FoldMirror::Path::illumination) {
            if (!(fold.distance >= 0 && fold.distance < splitter_from_illuminator)) {
                refuse(key_of(fold), fmt::format("{}", fold.distance),
                       fmt::format("a place between the illuminator and the beam splitter {:.6g} mm behind it",
                                   splitter_from_illuminator),
                       "Move the fold mirror.");
            }
            add_fold(fold, illuminator_last.along_z(fold.distance), between);
        }
    }
    std::ranges::stable_sort(between, {}, &Inserted::distance);
    if (description.illumination_aperture_radius) {
        require_positive(*description.illumination_aperture_radius, "illumination.aperture_radius_mm");
        PlacedSurface aperture = dummy_plane(air, entry.along_z(-*source_distance), "illumination aperture");
        aperture.surface.flags |= physics::f64::SURFACE_CLIPPED;
        aperture.surface.semi_diameter_squared =
            *description.illumination_aperture_radius * *description.illumination_aperture_radius;
        illuminator.insert(illuminator.begin(), aperture);
    }
    illumination_train = illuminator;
    instrument.illumination_surfaces_before_splitter = static_cast<int>(illumination_train.size());
    for (const Inserted& part : between) {
        append(illumination_train, part.surfaces);
        instrument.illumination_surfaces_before_splitter += part.distance < splitter_from_illuminator
                                                                ? static_cast<int>(part.surfaces.size())
                                                            : part.surfaces.size() == 2 ? 1 // the cube's first face
                                                                                        : 0;
    }
    append(illumination_train, reversed(objective));
    append(illumination_train, reversed(cover));
    const PlacedSurface exit_plane = dummy_plane(object_index, front.half_turn(), "front vertex' plane");
    const Surface to_exit = transfer_between(illumination_train.back().pose, exit_plane);
    constexpr double rounding = 1e-12; // mm
    if (is_displaced(to_exit) || std::abs(to_exit.distance) > rounding) {
        illumination_train.push_back(exit_plane);
    }
    link(illumination_train, entry);
    const std::vector<Surface> illumination_surfaces = surfaces_of(illumination_train);
    const auto field_stop = surface_with_role(illuminator, Role::field_stop);
    if (field_stop && (illuminator[*field_stop].surface.flags & physics::f64::SURFACE_CLIPPED) != 0) {
        const RayTransfer before = transfer_to_surface(illumination_surfaces, *field_stop);
        const RayTransfer whole = transfer_of_train(illumination_surfaces)
                                      .then(free_space(first_order.working_distance, object_index.centre));
        // whole = after * before, so after = whole * before^-1; its first element is the stop's
        // magnification.
        const double magnification = whole.a * before.d - whole.b * before.c;
        const double lit_radius =
            std::abs(magnification) * std::sqrt(illuminator[*field_stop].surface.semi_diameter_squared);
        if (lit_radius < field_half_diagonal) {
            instrument.warnings.push_back(
                fmt::format("The field stop's image, {:.4g} mm in radius on the specimen, does not cover the "
                            "detector's field, {:.4g} mm to its corners.",
                            lit_radius, field_half_diagonal));
        }
    }
    // Without a field stop the last surface limits the field as well as any.
    const bool straight =
        std::ranges::none_of(illumination_surfaces, [](const Surface& surface) { return is_displaced(surface); });
    const auto stop_transfer = transfer_to_surface(illumination_surfaces, field_stop.value_or(illuminator.size() - 1));
    const DiscSource source = {
        .radius = description.source_radius, .distance = *source_distance, .monochromatic = spectrum.monochromatic()};
    const RayTransfer towards_stop =
        free_space(*source_distance + illumination_surfaces.front().distance).then(stop_transfer);
    aimed_sine = emission_sine(illumination_surfaces, straight, source,
                               largest_sampled_sine(illumination_surfaces, straight, source, towards_stop));
    if (!(aimed_sine > 0)) {
        refuse("illumination.prescription", prescribed.name, "an illuminator whose light passes the objective",
               "Check distances and semi-diameters.", prescribed.file);
    }
    instrument.source_pose = entry.along_z(-*source_distance);
}

} // namespace vkfv::optics
