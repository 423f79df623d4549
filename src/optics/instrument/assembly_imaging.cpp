#include "optics/instrument/assembly.hpp"

#include "core/mathematics/units.hpp"
#include "core/threads/parallel_list.hpp"
#include "optics/aim/best_focus.hpp"
#include "optics/train/first_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <numeric>

namespace vkfv::optics {

using physics::f64::Surface;

namespace {

PlacedSplitter place_splitter(const InstrumentDescription& description, const AxialLayout& layout) {
    const BeamSplitter& splitter = description.splitter;
    const char* name = name_of(Part::beam_splitter);
    PlacedSplitter placed;
    placed.distance = splitter.distance.value_or(0.5 * description.objective_to_tube_lens);
    placed.height = layout.objective_back + placed.distance;
    // The coated side faces the specimen and the illuminator, which stands at +y.
    constexpr double quarter_turn = pi / 2;
    placed.pose = Pose{}.along_z(placed.height).turned({.tilt_x = 0.5 * quarter_turn});
    placed.half_size = 0.5 * splitter.size;
    if (splitter.kind == BeamSplitter::Kind::plate) {
        placed.surfaces =
            plate(description, placed.pose, splitter.size, splitter.glass, Medium::air(), splitter.semi_diameter, name);
        // The splitter's reflectance already contains the reflection of the coated side.
        placed.surfaces.front().surface.flags &= ~(physics::f64::SURFACE_FRESNEL | physics::f64::SURFACE_LAYER);
    } else if (splitter.kind == BeamSplitter::Kind::cube) {
        placed.surfaces = plate(description, Pose{}.along_z(placed.height - placed.half_size), splitter.size,
                                splitter.glass, Medium::air(), splitter.semi_diameter.value_or(placed.half_size), name);
    }
    return placed;
}

std::vector<Fold> place_folds(const InstrumentDescription& description, const AxialLayout& layout,
                              const PlacedSplitter& splitter) {
    std::vector<Fold> folds;
    for (const FoldMirror& mirror : description.fold_mirrors) {
        if (mirror.path != FoldMirror::Path::imaging) {
            continue;
        }
        if (!(mirror.distance > splitter.distance)) {
            refuse(distance_key(description, mirror), fmt::format("{}", mirror.distance),
                   fmt::format("a place behind the beam splitter, which is {:.6g} mm behind the objective",
                               splitter.distance),
                   "Move the fold mirror or the beam splitter.");
        }
        folds.push_back(place_fold(mirror, layout.air, Pose{}.along_z(layout.objective_back + mirror.distance)));
    }
    std::ranges::stable_sort(folds, {}, &Fold::distance);
    return folds;
}

// Appends the beam splitter, then the fold mirrors, which stand behind it.
void append_infinity_space(PlacedSurfaces& train, const InstrumentDescription& description,
                           const PlacedSplitter& splitter, const std::vector<Fold>& folds) {
    const auto stand = [&](double distance, const PlacedSurfaces& surfaces) {
        if (!(distance >= 0 && distance <= description.objective_to_tube_lens)) {
            refuse("tube_lens.distance_mm", fmt::format("{}", description.objective_to_tube_lens),
                   fmt::format("room for what stands {:.6g} mm behind the objective", distance),
                   "Move the beam splitter or fold mirror, or the tube lens.");
        }
        append(train, surfaces);
    };
    stand(splitter.distance, splitter.surfaces);
    for (const Fold& fold : folds) {
        stand(fold.distance, {fold.mirror});
    }
}

std::size_t aperture_stop_of(const InstrumentDescription& description, const PlacedSurfaces& objective) {
    const auto stop = surface_with_role(objective, SurfaceRole::aperture_stop);
    if (!stop || (objective[*stop].surface.flags & physics::f64::SURFACE_CLIPPED) == 0) {
        refuse("objective.prescription", description.objective.name,
               "one surface that is the aperture stop and has a semi-diameter",
               "Mark the surface that limits the cone with role = \"aperture stop\".", description.objective.file);
    }
    return *stop;
}

PlacedSurfaces train_from_detector(const AxialLayout& layout, const PlacedSurfaces& imaging,
                                   const Pose& detector_pose) {
    PlacedSurfaces train = reversed(imaging);
    end_in(train, dummy_plane(layout.object_index, layout.front.half_turn(), "front vertex' plane"));
    link(train, detector_pose.half_turn());
    return train;
}

} // namespace

ImagingTrain place_imaging(const InstrumentDescription& description, const AxialLayout& layout) {
    ImagingTrain result;
    Pose end;
    result.objective =
        place_prescription(layout.objective_lens, description.spectrum, description.interfaces,
                           placed_at(description.objective_placement, Pose{}.along_z(layout.objective_front)), end);
    result.splitter = place_splitter(description, layout);
    result.folds = place_folds(description, layout, result.splitter);
    PlacedSurfaces& train = result.train;
    train = layout.cover;
    append(train, result.objective);
    result.surfaces_before_splitter = static_cast<int>(train.size()) + (result.splitter.surfaces.empty() ? 0 : 1);
    append_infinity_space(train, description, result.splitter, result.folds);
    const Pose tube_lens_nominal = Pose{}.along_z(layout.objective_back + description.objective_to_tube_lens);
    result.tube_lens = place_prescription(description.tube_lens, description.spectrum, description.interfaces,
                                          placed_at(description.tube_lens_placement, tube_lens_nominal), end);
    append(train, result.tube_lens);
    const double tube_lens_length = layout.straight_tube_lens.back().pose.origin.z;
    result.detector_pose = placed_at(description.detector_placement,
                                     tube_lens_nominal.along_z(tube_lens_length + layout.detector_distance));
    const PlacedSurface detector_plane = dummy_plane(layout.air, result.detector_pose, "detector's plane");
    if (is_displaced(transfer_between(train.back().pose, detector_plane))) {
        train.push_back(detector_plane);
    }
    link(train, layout.front);

    result.aperture_stop = aperture_stop_of(description, result.objective);
    Imaging& imaging = result.imaging;
    imaging.train = surfaces_of(train);
    imaging.working_distance = layout.working_distance;
    imaging.detector_distance =
        glm::dot(result.detector_pose.origin - train.back().pose.origin, train.back().pose.axes[2]);
    const EntrancePupil pupil =
        entrance_pupil(free_space(layout.working_distance, layout.object_index.centre)
                           .then(transfer_to_surface(imaging.train, layout.cover.size() + result.aperture_stop)));
    imaging.pupil_curvature = pupil.curvature / layout.object_index.centre;
    imaging.symmetric = !has_displaced(imaging.train);
    result.from_detector = surfaces_of(train_from_detector(layout, train, result.detector_pose));
    return result;
}

MeasuredImaging measure_imaging(const InstrumentDescription& description, const AxialLayout& layout,
                                const ImagingTrain& placed) {
    const Imaging& imaging = placed.imaging;
    const double index = layout.object_index.centre;
    MeasuredImaging measured;
    const Outline on_axis = outline_at(imaging, {0, 0});
    measured.numerical_aperture = index * std::sqrt(on_axis.area() / pi);
    if (!(measured.numerical_aperture > 0)) {
        refuse("objective.prescription", description.objective.name,
               "an objective and a tube lens through which the axial ray passes",
               "Check media, radii and semi-diameters.", description.objective.file);
    }
    measured.depth_of_field = index * description.spectrum.reference_um * mm_per_um /
                              (measured.numerical_aperture * measured.numerical_aperture);
    const Spectrum& spectrum = description.spectrum;
    constexpr int wavelengths = 9;
    const auto nodes =
        at_most(wavelengths, spectral_nodes(spectrum.bins, spectrum.centre(), spectrum.half_width(), wavelengths));
    const auto focus = [&](const Outline& outline) {
        return best_focus(imaging, layout.magnification, outline, nodes);
    };
    // The mean over opposite directions keeps a tilt of the field from counting as curvature.
    const auto focus_all_round = [&](double distance) {
        const auto directions = search_directions(imaging.symmetric);
        const auto heights = parallel_list(static_cast<int>(directions.size()), [&](int i) {
            return focus(outline_at(imaging, distance * directions[static_cast<std::size_t>(i)]));
        });
        return std::accumulate(heights.begin(), heights.end(), 0.0) / static_cast<double>(heights.size());
    };
    auto edge_focus =
        std::async(std::launch::async, focus_all_round, std::max(layout.field_corner.x, layout.field_corner.y));
    measured.best_focus_offset = focus(on_axis);
    measured.least_spot_offset = least_spot(imaging, on_axis);
    measured.field_curvature_corner = focus_all_round(layout.field_half_diagonal) - measured.best_focus_offset;
    measured.field_curvature = edge_focus.get() - measured.best_focus_offset;
    const Outline at_corner = outline_at(imaging, {layout.field_half_diagonal, 0});
    const double relative_light = at_corner.area() / on_axis.area();
    if (relative_light < 0.9) {
        measured.warnings.push_back(
            {.code = "dark-corners",
             .key = "detector.size_mm",
             .value = number_text(description.detector_width),
             .works = "a smaller detector, or lenses with larger semi_diameter_mm",
             .sentence =
                 fmt::format("The corners of the detector's field receive {:.0f} % of the axial light: lens edges clip "
                             "their cones.",
                             100 * relative_light)});
    }
    return measured;
}

} // namespace vkfv::optics
