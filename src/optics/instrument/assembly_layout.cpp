#include "optics/instrument/assembly.hpp"

#include "core/mathematics/units.hpp"
#include "optics/train/first_order.hpp"

#include <fmt/format.h>

#include <algorithm>
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

// Lays out how far the image deviates from the lenses', and how far the detector's corners see by it.
void deviate(AxialLayout& layout, const InstrumentDescription& description) {
    const ImageDeviations& image = description.image;
    const double change = std::abs(image.magnification_rate) * image.greatest_height;
    constexpr double most_change = 0.1;
    if (!(change <= most_change)) {
        refuse("objective.magnification_per_um", fmt::format("{:.6g}", image.magnification_rate * mm_per_um),
               fmt::format("a magnification that changes by at most {:g} % from z = 0 to the ends of the scan",
                           100 * most_change),
               fmt::format("It changes by {:.3g} %: choose a smaller value.", 100 * change));
    }
    const ImageSize& pixels = description.detector_pixels;
    const glm::dvec2 corner = 0.5 * description.detector_width *
                              glm::dvec2(1, static_cast<double>(pixels.rows) / pixels.columns) / (1 - change);
    const double height = image.field_height * layout.magnification; // mm on the detector
    layout.image_distortion = image.distortion / (height * height);
    physics::f64::Instrument constants{};
    constants.image_distortion = layout.image_distortion;
    constants.image_shear = image_shear(image);
    const physics::f64::Exposure exposure{};
    for (const double side : {-1.0, 1.0}) {
        const glm::dvec2 recorded(corner.x, side * corner.y);
        const glm::dvec2 sheared(recorded.x - constants.image_shear * recorded.y, recorded.y);
        // Beyond these limits light would be recorded twice, or the third order alone describe no lens.
        constexpr double least = -0.12, most = 0.3;
        const double at_corner = layout.image_distortion * glm::dot(sheared, sheared);
        if (!(at_corner >= least && at_corner <= most)) {
            refuse(
                "detector.distortion", fmt::format("{:.6g}", 100 * image.distortion),
                fmt::format("a distortion from {:g} to {:g} % in the corners of the detector", 100 * least, 100 * most),
                fmt::format("It is {:.3g} % there: choose a smaller value, or a larger detector.distortion_field_mm.",
                            100 * at_corner));
        }
        const glm::dvec2 seen = physics::f64::arrival_place(constants, exposure, recorded).place;
        layout.reach = std::max(layout.reach, glm::length(seen) / ((1 - change) * glm::length(corner)));
    }
}

} // namespace

double image_shear(const ImageDeviations& image) {
    // Columns at more than a right angle to the rows lean against x: what arrives at (-tan(shear) y, y) is recorded at
    // (0, y).
    return std::tan(image.shear);
}

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
    deviate(layout, description);

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
