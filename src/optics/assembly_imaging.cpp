#include "optics/assembly.hpp"

#include "core/units.hpp"
#include "optics/first_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace vkfv::optics {

using physics::f64::Surface;
using Role = PrescribedSurface::Role;

void Assembly::lay_out() {
    // Paraxially: the object in the front focal plane of the objective behind its cover glass, the detector
    // in the tube lens' back focal plane.
    objective_lens = with_stop(description.objective, Role::aperture_stop, description.aperture_stop_radius,
                               "objective.aperture_stop_radius_mm");
    if (description.immersion) {
        objective_lens.medium_before = *description.immersion;
    }
    const Medium& object_medium = objective_lens.medium_before;
    object_index = spectral_index(object_medium, spectrum);
    first_order.object_index = object_index.centre;
    Pose end;
    straight_objective = place_prescription(objective_lens, spectrum, description.interfaces, Pose{}, end);
    const double objective_length = end.origin.z;
    require_air(straight_objective.back().surface.index_after, description.objective, "objective.prescription");
    const RayTransfer objective_transfer = transfer_of(straight_objective);
    straight_tube_lens = place_prescription(description.tube_lens, spectrum, description.interfaces, Pose{}, end);
    require_air(straight_tube_lens.front().surface.index_before, description.tube_lens, "tube_lens.prescription");
    require_air(straight_tube_lens.back().surface.index_after, description.tube_lens, "tube_lens.prescription");
    const RayTransfer tube_lens_transfer = transfer_of(straight_tube_lens);
    first_order.efl_objective = focal_length(objective_transfer);
    first_order.efl_tube_lens = focal_length(tube_lens_transfer);
    // Without a cover glass; in the medium before the objective.
    const double free_distance = object_index.centre * front_focal_distance(objective_transfer);
    detector_distance = back_focal_distance(tube_lens_transfer);
    if (!(free_distance > 0 && std::isfinite(free_distance))) {
        refuse("objective.prescription", description.objective.name,
               "an objective whose front focal point lies in front of its first surface",
               "List it from the specimen to the back.", description.objective.file);
    }
    if (!(detector_distance > 0 && std::isfinite(detector_distance))) {
        refuse("tube_lens.prescription", description.tube_lens.name,
               "a tube lens whose back focal point lies behind its last surface",
               "List it from the objective to the detector.", description.tube_lens.file);
    }
    if (!(description.objective_to_tube_lens >= 0)) {
        refuse("tube_lens.distance_mm", fmt::format("{}", description.objective_to_tube_lens), "a number >= 0",
               "Correct it.");
    }
    first_order.magnification = -first_order.efl_tube_lens / first_order.efl_objective;
    const double absolute_magnification = std::abs(first_order.magnification);
    field_half_side = 0.5 * description.detector_size / absolute_magnification;
    field_half_diagonal = std::sqrt(2.0) * field_half_side;
    first_order.pixel_pitch = description.detector_size / description.detector_pixels / absolute_magnification;
    first_order.field_edge = field_half_side;

    // Heights over the paraxial object plane. A plate of thickness t shortens the way by t (1 - n0 / n).
    objective_front = free_distance;
    first_order.working_distance = free_distance;
    if (description.cover_glass) {
        const CoverGlass& glass = *description.cover_glass;
        require_positive(glass.thickness, "cover_glass.thickness_mm");
        const double index = glass.glass.index(spectrum.reference_um);
        const double free_way = free_distance - glass.thickness * object_index.centre / index;
        const double height = glass.distance.value_or(0.5 * free_way);
        if (!(height > 0 && height < free_way)) {
            refuse("cover_glass.thickness_mm", fmt::format("{} mm, {:.6g} mm over the focus", glass.thickness, height),
                   fmt::format("a plate between the focus and the objective, which is {:.6g} mm away without it",
                               free_distance),
                   "Choose a thinner plate, or another distance_mm.");
        }
        cover = plate(Pose{}.along_z(height), glass.thickness, glass.glass, object_medium, std::nullopt, "cover glass");
        objective_front = free_way + glass.thickness;
        first_order.working_distance = height;
    }
    front = Pose{}.along_z(first_order.working_distance);
    back = objective_front + objective_length;
}

void Assembly::assemble_imaging() {
    // Imaging, from the specimen to the detector.
    Pose end;
    objective = place_prescription(objective_lens, spectrum, description.interfaces,
                                   placed_at(description.objective_placement, Pose{}.along_z(objective_front)), end);
    splitter_distance = splitter.distance.value_or(0.5 * description.objective_to_tube_lens);
    splitter_height = back + splitter_distance;
    // The coated side faces the specimen and the illuminator, which stands at +y.
    constexpr double quarter_turn = pi / 2;
    splitter_pose = Pose{}.along_z(splitter_height).turned({.tilt_x = 0.5 * quarter_turn});
    half_size = 0.5 * splitter.size;
    int splitter_surfaces_before = 0;
    if (splitter.kind == BeamSplitter::Kind::plate) {
        splitter_imaging =
            plate(splitter_pose, splitter.size, splitter.glass, Medium::air(), splitter.semi_diameter, "beam splitter");
        // What its coating reflects is the splitter's reflectance.
        splitter_imaging.front().surface.flags &= ~(physics::f64::SURFACE_FRESNEL | physics::f64::SURFACE_LAYER);
        splitter_surfaces_before = 1;
    } else if (splitter.kind == BeamSplitter::Kind::cube) {
        splitter_imaging = plate(Pose{}.along_z(splitter_height - half_size), splitter.size, splitter.glass,
                                 Medium::air(), splitter.semi_diameter.value_or(half_size), "beam splitter");
        splitter_surfaces_before = 1;
    }
    std::vector<Inserted> inserted = {{splitter_distance, splitter_imaging}};
    for (const FoldMirror& fold : description.fold_mirrors) {
        if (fold.path == FoldMirror::Path::imaging) {
            if (!(fold.distance > splitter_distance)) {
                refuse(key_of(fold), fmt::format("{}", fold.distance),
                       fmt::format("a place behind the beam splitter, which is {:.6g} mm behind the objective",
                                   splitter_distance),
                       "Move the fold mirror or the beam splitter.");
            }
            add_fold(fold, Pose{}.along_z(back + fold.distance), inserted);
        }
    }
    std::ranges::stable_sort(inserted, {}, &Inserted::distance);
    imaging_train = cover;
    append(imaging_train, objective);
    instrument.imaging_surfaces_before_splitter = static_cast<int>(imaging_train.size()) + splitter_surfaces_before;
    for (const Inserted& part : inserted) {
        if (!(part.distance >= 0 && part.distance <= description.objective_to_tube_lens)) {
            refuse("tube_lens.distance_mm", fmt::format("{}", description.objective_to_tube_lens),
                   fmt::format("room for what stands {:.6g} mm behind the objective", part.distance),
                   "Move the beam splitter or fold mirror, or the tube lens.");
        }
        append(imaging_train, part.surfaces);
    }
    const Pose tube_lens_nominal = Pose{}.along_z(back + description.objective_to_tube_lens);
    tube_lens = place_prescription(description.tube_lens, spectrum, description.interfaces,
                                   placed_at(description.tube_lens_placement, tube_lens_nominal), end);
    append(imaging_train, tube_lens);
    const double tube_lens_length = straight_tube_lens.back().pose.origin.z;
    detector_pose =
        placed_at(description.detector_placement, tube_lens_nominal.along_z(tube_lens_length + detector_distance));
    const PlacedSurface detector_plane = dummy_plane(air, detector_pose, "detector's plane");
    if (is_displaced(transfer_between(imaging_train.back().pose, detector_plane))) {
        imaging_train.push_back(detector_plane);
    }
    link(imaging_train, front);
    constants.detector_distance =
        glm::dot(detector_pose.origin - imaging_train.back().pose.origin, imaging_train.back().pose.axes[2]);

    aperture_stop = surface_with_role(objective, Role::aperture_stop);
    if (!aperture_stop || (objective[*aperture_stop].surface.flags & physics::f64::SURFACE_CLIPPED) == 0) {
        refuse("objective.prescription", description.objective.name,
               "one surface that is the aperture stop and has a semi-diameter",
               "Mark the surface that limits the cone with role = \"aperture stop\".", description.objective.file);
    }
    imaging_surfaces = surfaces_of(imaging_train);
    const EntrancePupil pupil =
        entrance_pupil(free_space(first_order.working_distance, object_index.centre)
                           .then(transfer_to_surface(imaging_surfaces, cover.size() + *aperture_stop)));
    const bool displaced =
        std::ranges::any_of(imaging_surfaces, [](const Surface& surface) { return is_displaced(surface); });
    imaging = {.train = imaging_surfaces,
               .working_distance = first_order.working_distance,
               .detector_distance = constants.detector_distance,
               .pupil_curvature = pupil.curvature / object_index.centre,
               .symmetric = !displaced};
}

void Assembly::measure_imaging() {
    const Outline on_axis = outline_at(imaging, {0, 0});
    first_order.numerical_aperture = object_index.centre * std::sqrt(on_axis.area() / pi);
    if (!(first_order.numerical_aperture > 0)) {
        refuse("objective.prescription", description.objective.name,
               "an objective and a tube lens through which the axial ray passes",
               "Check media, radii and semi-diameters.", description.objective.file);
    }
    first_order.depth_of_field = object_index.centre * spectrum.reference_um * mm_per_um /
                                 (first_order.numerical_aperture * first_order.numerical_aperture);
    first_order.best_focus_offset = best_focus(imaging, on_axis);
    first_order.field_curvature =
        best_focus(imaging, outline_at(imaging, {field_half_side, 0})) - first_order.best_focus_offset;
    instrument.front_vertex_height = first_order.working_distance - first_order.best_focus_offset;

    const Outline at_corner = outline_at(imaging, {field_half_diagonal, 0});
    first_order.field_curvature_corner = best_focus(imaging, at_corner) - first_order.best_focus_offset;
    const double relative_light = at_corner.area() / on_axis.area();
    if (relative_light < 0.9) {
        instrument.warnings.push_back(
            fmt::format("The corners of the detector's field receive {:.0f} % of the axial light: lens edges clip "
                        "their cones.",
                        100 * relative_light));
    }
}

} // namespace vkfv::optics
