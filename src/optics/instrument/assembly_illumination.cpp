#include "optics/instrument/assembly.hpp"

#include "optics/aim/aim.hpp"
#include "optics/train/first_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace vkfv::optics {

using physics::f64::Surface;

namespace {

// Moves a whole part: its pose relative to `from` becomes its pose relative to `to`.
void move(PlacedSurfaces& part, const Pose& from, const Pose& to) {
    const glm::dmat3 turn = to.axes * glm::transpose(from.axes);
    for (PlacedSurface& placed : part) {
        placed.pose = {to.origin + turn * (placed.pose.origin - from.origin), turn * placed.pose.axes};
    }
}

double source_distance_of(const InstrumentDescription& description, const Prescription& prescribed) {
    const std::optional<double> distance =
        description.source.distance ? description.source.distance : prescribed.source_distance;
    if (!distance || !(*distance >= 0)) {
        refuse(description.source.key + ".distance_mm", distance ? fmt::format("{}", *distance) : "",
               "the distance from the source to the illuminator, >= 0",
               "Give it, or source_distance_mm in the prescription.", prescribed.file);
    }
    return *distance;
}

// The objective's paraxial pupil seen from the back (mm).
struct BackPupil {
    double distance = 0; // behind the objective's last vertex, in the illumination's direction
    double radius = 0;
};

BackPupil back_pupil_of(const AxialLayout& layout, const ImagingTrain& imaging) {
    PlacedSurfaces straight_backward = reversed(layout.straight_objective);
    link(straight_backward, straight_backward.front().pose);
    const std::size_t stop_backward = imaging.objective.size() - 1 - imaging.aperture_stop;
    const RayTransfer back_to_stop = transfer_to_surface(surfaces_of(straight_backward), stop_backward);
    const EntrancePupil back_pupil = entrance_pupil(back_to_stop);
    const double stop_radius = std::sqrt(imaging.objective[imaging.aperture_stop].surface.semi_diameter_squared);
    // The stop's image has 1 / a its size; there is none for a = 0. A pupil on the vertex has the distance 0, even at
    // infinite curvature.
    return {.distance = back_to_stop.b == 0 ? 0 : 1 / back_pupil.curvature,
            .radius = stop_radius / std::abs(back_to_stop.a)};
}

// The image of the source in the objective's pupil. Lengths in mm.
struct PupilFilling {
    double to_objective = 0; // from the illuminator's last vertex to the objective's
    double magnification = 0;
    double pupil_radius_in_source = 0;
    std::vector<Warning> warnings;
};

PupilFilling fill_pupil(const InstrumentDescription& description, const Prescription& prescribed,
                        const BackPupil& pupil, const ParaxialImage& source_image, double efl_objective) {
    const BeamSplitter& splitter = description.splitter;
    PupilFilling result;
    // The cube's glass shifts the source's image away.
    const double glass_shift = splitter.kind == BeamSplitter::Kind::cube
                                   ? splitter.size * (1 - 1 / splitter.glass.index(description.spectrum.reference_um))
                                   : 0;
    result.to_objective =
        description.illumination_to_objective.value_or(source_image.distance - pupil.distance + glass_shift);
    if (!(result.to_objective >= 0 && std::isfinite(result.to_objective))) {
        refuse("illumination.objective_distance_mm", fmt::format("{:.6g}", result.to_objective),
               fmt::format("room between {} and {} so that the source is imaged into the pupil", prescribed.name,
                           description.objective.name),
               "Give a distance >= 0, or move the source nearer to the illuminator's focal plane.", prescribed.file);
    }
    result.magnification = source_image.magnification;
    result.pupil_radius_in_source = pupil.radius / std::abs(source_image.magnification);
    const double inner_radius = description.source.inner_radius();
    const double filling_radius =
        std::min(inner_radius, description.illumination_aperture_radius.value_or(inner_radius));
    if (filling_radius < 0.98 * result.pupil_radius_in_source) {
        // The stop at the source limits the light if it is the smaller one.
        const bool by_stop = filling_radius < inner_radius;
        const bool rectangle = description.source.rectangle.has_value();
        const auto* const sides = rectangle ? &*description.source.rectangle : nullptr;
        const char* const key = by_stop                ? "illumination.aperture_radius_mm"
                                : !rectangle           ? "source.radius_mm"
                                : sides->x <= sides->y ? "source.width_mm"
                                                       : "source.height_mm";
        const double times = rectangle && !by_stop ? 2 : 1; // a side, not its half
        result.warnings.push_back(
            {.code = "pupil-not-filled",
             .key = key,
             .value = number_text(times * filling_radius),
             .works = number_text(times * result.pupil_radius_in_source, Rounding::up),
             .sentence = fmt::format(
                 "The source does not fill the objective's pupil: its {} is {:.4g} mm, filling takes "
                 "{:.4g} mm.",
                 rectangle ? "shorter side's half" : "radius", filling_radius, result.pupil_radius_in_source)});
    }
    const double image_to_pupil = result.to_objective + pupil.distance - glass_shift - source_image.distance;
    if (!(std::abs(image_to_pupil) < 0.05 * efl_objective)) {
        result.warnings.push_back(
            {.code = "source-beside-pupil",
             .key = "illumination.objective_distance_mm",
             .value = number_text(result.to_objective),
             .works = number_text(result.to_objective - image_to_pupil),
             .sentence =
                 fmt::format("The source is imaged {:.3g} mm in front of the objective's pupil instead of into it.",
                             image_to_pupil)});
    }
    return result;
}

// Fold mirrors of the illumination in the unfolded space, placed behind `illuminator_last`.
std::vector<Fold> place_folds(const InstrumentDescription& description, const AxialLayout& layout,
                              const Pose& illuminator_last, double splitter_from_illuminator) {
    std::vector<Fold> folds;
    for (const FoldMirror& mirror : description.fold_mirrors) {
        if (mirror.path != FoldMirror::Path::illumination) {
            continue;
        }
        if (!(mirror.distance >= 0 && mirror.distance < splitter_from_illuminator)) {
            refuse(distance_key(description, mirror), fmt::format("{}", mirror.distance),
                   fmt::format("a place between the illuminator and the beam splitter {:.6g} mm behind it",
                               splitter_from_illuminator),
                   "Move the fold mirror.");
        }
        folds.push_back(place_fold(mirror, layout.air, illuminator_last.along_z(mirror.distance)));
    }
    std::ranges::stable_sort(folds, {}, &Fold::distance);
    return folds;
}

PlacedSurface illumination_aperture(const AxialLayout& layout, const Pose& source, double radius) {
    require_positive(radius, "illumination.aperture_radius_mm");
    PlacedSurface aperture = dummy_plane(layout.air, source, name_of(SurfaceRole::illumination_aperture));
    aperture.name.role = SurfaceRole::illumination_aperture;
    aperture.surface.flags |= physics::f64::SURFACE_CLIPPED;
    aperture.surface.semi_diameter_squared = radius * radius;
    return aperture;
}

// The train from the source to the specimen, linked from `entry`.
struct JoinedTrain {
    PlacedSurfaces surfaces;
    int before_splitter = 0;
};

JoinedTrain join_train(const InstrumentDescription& description, const AxialLayout& layout, const ImagingTrain& imaging,
                       const PlacedSurfaces& illuminator, const std::vector<Fold>& folds, const Pose& entry) {
    const BeamSplitter& splitter = description.splitter;
    JoinedTrain train = {.surfaces = illuminator};
    for (const Fold& fold : folds) {
        train.surfaces.push_back(fold.mirror);
    }
    train.before_splitter = static_cast<int>(train.surfaces.size());
    if (splitter.kind == BeamSplitter::Kind::cube) {
        const PlacedSplitter& placed = imaging.splitter;
        append(train.surfaces,
               plate(description, downward(placed.height + placed.half_size), splitter.size, splitter.glass,
                     Medium::air(), splitter.semi_diameter.value_or(placed.half_size), name_of(Part::beam_splitter)));
        ++train.before_splitter; // the cube's first face
    }
    append(train.surfaces, reversed(imaging.objective));
    append(train.surfaces, reversed(layout.cover));
    end_in(train.surfaces, dummy_plane(layout.object_index, layout.front.half_turn(), "front vertex' plane"));
    link(train.surfaces, entry);
    return train;
}

// The signed magnification of the field stop's image on the specimen.
double field_stop_magnification(const AxialLayout& layout, const std::vector<Surface>& train, std::size_t stop_index) {
    const RayTransfer before = transfer_to_surface(train, stop_index);
    const RayTransfer whole =
        transfer_of_train(train).then(free_space(layout.working_distance, layout.object_index.centre));
    // From whole = after * before follows after = whole * before^-1, whose first element is the stop's magnification.
    return whole.a * before.d - whole.b * before.c;
}

// Warns if the field stop's image leaves part of the detector's field dark.
std::vector<Warning> warning_of_field_stop(const AxialLayout& layout, const Surface& stop, double magnification) {
    const double lit_radius = std::abs(magnification) * std::sqrt(stop.semi_diameter_squared);
    if (!(lit_radius < layout.seen_half_diagonal())) {
        return {};
    }
    constexpr double margin = 1.05; // aberrations blur the rim by a few percent
    return {{.code = "small-field-stop",
             .key = "illumination.field_stop_radius_mm",
             .value = number_text(std::sqrt(stop.semi_diameter_squared)),
             .works = number_text(margin * layout.seen_half_diagonal() / std::abs(magnification), Rounding::up),
             .sentence = fmt::format("The field stop's image, {:.4g} mm in radius on the specimen, does not cover the "
                                     "detector's field, {:.4g} mm to its corners.",
                                     lit_radius, layout.seen_half_diagonal())}};
}

// stop: index of the surface about whose centre light is sampled.
Aim aim_of(const InstrumentDescription& description, const Prescription& prescribed, const std::vector<Surface>& train,
           std::size_t stop, double source_distance) {
    const bool straight = !has_displaced(train);
    const DiscSource source = {.radius = description.source.outer_radius(),
                               .distance = source_distance,
                               .monochromatic = description.spectrum.monochromatic()};
    const RayTransfer towards_stop =
        free_space(source_distance + train.front().distance).then(transfer_to_surface(train, stop));
    const std::vector<RimRay> rim = sampled_rim(train, straight, source, towards_stop);
    if (!description.directed_emission && !rim.empty()) {
        return {}; // the hemisphere, as it is known that some light passes
    }
    const Aim aim = best_aim(train, straight, source, rim);
    if (!(aim.sine > 0)) {
        refuse("illumination.prescription", prescribed.name, "an illuminator whose light passes the objective",
               "Check distances and semi-diameters.", prescribed.file);
    }
    return aim;
}

} // namespace

Illumination place_illuminator(const InstrumentDescription& description, const AxialLayout& layout,
                               const ImagingTrain& imaging) {
    require_surfaces(description.illumination, "illumination.prescription");
    const Prescription prescribed = with_stop(description.illumination, SurfaceRole::field_stop,
                                              description.field_stop_radius, "illumination.field_stop_radius_mm");
    Illumination result;
    Pose end;
    result.illuminator = place_prescription(prescribed, description.spectrum, description.interfaces, Pose{}, end);
    require_air(result.illuminator.front().surface.index_before, prescribed, "illumination.prescription");
    require_air(result.illuminator.back().surface.index_after, prescribed, "illumination.prescription");
    const RayTransfer transfer = transfer_of(result.illuminator);
    result.source_distance = source_distance_of(description, prescribed);
    const PupilFilling filling = fill_pupil(description, prescribed, back_pupil_of(layout, imaging),
                                            image_of(transfer, result.source_distance), layout.efl_objective);
    result.to_objective = filling.to_objective;
    result.source_magnification = filling.magnification;
    result.pupil_radius_in_source = filling.pupil_radius_in_source;
    result.warnings = filling.warnings;

    const Pose last = downward(layout.objective_back + filling.to_objective);
    move(result.illuminator, end, last);
    const Pose entry = {last.origin - last.axes * (glm::transpose(end.axes) * end.origin),
                        last.axes * glm::transpose(end.axes)};
    result.source_pose = entry.along_z(-result.source_distance);
    result.folds = place_folds(description, layout, last, filling.to_objective - imaging.splitter.distance);
    if (description.illumination_aperture_radius) {
        result.illuminator.insert(
            result.illuminator.begin(),
            illumination_aperture(layout, result.source_pose, *description.illumination_aperture_radius));
    }
    const auto field_stop = surface_with_role(result.illuminator, SurfaceRole::field_stop);
    if (description.light_field) {
        if (!field_stop) {
            refuse("illumination.field", prescribed.name, "an illuminator with a field stop, in whose plane it stands",
                   "Take another prescription, or give a surface of it role = \"field stop\".", prescribed.file);
        }
        result.illuminator[*field_stop].surface.flags |= physics::f64::SURFACE_LIGHT_FIELD;
    }
    JoinedTrain train = join_train(description, layout, imaging, result.illuminator, result.folds, entry);
    result.train = std::move(train.surfaces);
    result.surfaces_before_splitter = train.before_splitter;

    const std::vector<Surface> surfaces = surfaces_of(result.train);
    if (field_stop) {
        result.field_stop_magnification = field_stop_magnification(layout, surfaces, *field_stop);
        const Surface& stop = result.illuminator[*field_stop].surface;
        if ((stop.flags & physics::f64::SURFACE_CLIPPED) != 0) {
            std::ranges::move(warning_of_field_stop(layout, stop, result.field_stop_magnification),
                              std::back_inserter(result.warnings));
        }
    }
    // Without a field stop the last surface serves as the limit of the field.
    result.aim = aim_of(description, prescribed, surfaces, field_stop.value_or(result.illuminator.size() - 1),
                        result.source_distance);
    return result;
}

} // namespace vkfv::optics
