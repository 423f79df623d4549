#include "optics/instrument/assembly.hpp"

#include "optics/train/first_order.hpp"

#include <fmt/format.h>

#include <cmath>

namespace vkfv::optics {

namespace {

// Places the objective without its cover glass and the tube lens, and computes their focal lengths.
AxialLayout place_lenses(const InstrumentDescription& description) {
    AxialLayout layout;
    layout.air = spectral_index(Medium::air(), description.spectrum);
    layout.objective_lens = with_stop(description.objective, SurfaceRole::aperture_stop,
                                      description.aperture_stop_radius, "objective.aperture_stop_radius_mm");
    if (description.immersion) {
        layout.objective_lens.medium_before = *description.immersion;
    }
    layout.object_index = spectral_index(layout.objective_lens.medium_before, description.spectrum);
    Pose end;
    layout.straight_objective =
        place_prescription(layout.objective_lens, description.spectrum, description.interfaces, Pose{}, end);
    require_air(layout.straight_objective.back().surface.index_after, description.objective, "objective.prescription");
    const RayTransfer objective_transfer = transfer_of(layout.straight_objective);
    layout.straight_tube_lens =
        place_prescription(description.tube_lens, description.spectrum, description.interfaces, Pose{}, end);
    require_air(layout.straight_tube_lens.front().surface.index_before, description.tube_lens,
                "tube_lens.prescription");
    require_air(layout.straight_tube_lens.back().surface.index_after, description.tube_lens, "tube_lens.prescription");
    const RayTransfer tube_lens_transfer = transfer_of(layout.straight_tube_lens);
    layout.efl_objective = focal_length(objective_transfer);
    layout.efl_tube_lens = focal_length(tube_lens_transfer);
    // The focal distance is reduced by the index: multiply by that of the medium before the objective.
    layout.working_distance = layout.object_index.centre * front_focal_distance(objective_transfer);
    layout.detector_distance = back_focal_distance(tube_lens_transfer);
    if (!(layout.working_distance > 0 && std::isfinite(layout.working_distance))) {
        refuse("objective.prescription", description.objective.name,
               "an objective whose front focal point lies in front of its first surface",
               "List it from the specimen to the back: vkfv import --reverse does so.", description.objective.file);
    }
    if (!(layout.detector_distance > 0 && std::isfinite(layout.detector_distance))) {
        refuse("tube_lens.prescription", description.tube_lens.name,
               "a tube lens whose back focal point lies behind its last surface",
               "List it from the objective to the detector.", description.tube_lens.file);
    }
    return layout;
}

} // namespace

AxialLayout lay_out(const InstrumentDescription& description) {
    AxialLayout layout = place_lenses(description);
    if (!(description.objective_to_tube_lens >= 0)) {
        refuse("tube_lens.distance_mm", fmt::format("{}", description.objective_to_tube_lens), "a number >= 0",
               "Correct it.");
    }
    layout.magnification = -layout.efl_tube_lens / layout.efl_objective;
    const double half_width = 0.5 * description.detector_width / std::abs(layout.magnification);
    const ImageSize& pixels = description.detector_pixels;
    layout.field_corner = {half_width, half_width * pixels.rows / pixels.columns};
    layout.field_half_diagonal = glm::length(layout.field_corner);

    // A plate of thickness t and index n raises the focus by t (1 - n0 / n) in a medium of index n0.
    const double free_distance = layout.working_distance;
    layout.objective_front = free_distance;
    if (description.cover_glass) {
        const CoverGlass& glass = *description.cover_glass;
        require_positive(glass.thickness, "cover_glass.thickness_mm");
        const double index = glass.glass.index(description.spectrum.reference_um);
        const double free_way = free_distance - glass.thickness * layout.object_index.centre / index;
        const double height = glass.distance.value_or(0.5 * free_way);
        if (!(height > 0 && height < free_way)) {
            refuse("cover_glass.thickness_mm", fmt::format("{} mm, {:.6g} mm over the focus", glass.thickness, height),
                   fmt::format("a plate between the focus and the objective, which is {:.6g} mm away without it",
                               free_distance),
                   "Choose a thinner plate, or another distance_mm.");
        }
        layout.cover = plate(description, Pose{}.along_z(height), glass.thickness, glass.glass,
                             layout.objective_lens.medium_before, std::nullopt, name_of(Part::cover_glass));
        layout.objective_front = free_way + glass.thickness;
        layout.working_distance = height;
    }
    layout.front = Pose{}.along_z(layout.working_distance);
    layout.objective_back = layout.objective_front + layout.straight_objective.back().pose.origin.z;
    return layout;
}

} // namespace vkfv::optics
