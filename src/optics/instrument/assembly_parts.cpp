#include "optics/instrument/assembly.hpp"

#include "core/messages/error.hpp"
#include "optics/train/first_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace vkfv::optics {

using physics::f64::Surface;

void refuse(std::string key, std::string found, std::string expected, std::string remedy,
            const std::filesystem::path& file) {
    throw InputError({.where = {.file = file},
                      .key = std::move(key),
                      .found = std::move(found),
                      .expected = std::move(expected),
                      .remedy = std::move(remedy)});
}

void require_positive(double value, const std::string& key) {
    if (!(value > 0 && std::isfinite(value))) {
        refuse(key, fmt::format("{}", value), "a finite number > 0", "Correct it.");
    }
}

void require_surfaces(const Prescription& prescription, const char* key) {
    if (prescription.surfaces.empty()) {
        refuse(key, prescription.name, "a prescription with surfaces", "Add a [[surface]].", prescription.file);
    }
}

void require_air(double index, const Prescription& prescription, const char* key) {
    if (index != 1) {
        refuse(key, prescription.name, "a part that stands in air",
               "Remove medium_before and the medium of the last surface.", prescription.file);
    }
}

Prescription with_stop(Prescription prescription, SurfaceRole role, std::optional<double> radius, const char* key) {
    if (!radius) {
        return prescription;
    }
    require_positive(*radius, key);
    const auto found = std::ranges::find(prescription.surfaces, role, &PrescribedSurface::role);
    if (found == prescription.surfaces.end()) {
        refuse(key, fmt::format("{}", *radius),
               fmt::format("a part with such a stop, which {} has not", prescription.name),
               "Leave the radius out, or mark a surface with its role.", prescription.file);
    }
    found->semi_diameter = radius;
    return prescription;
}

void append(PlacedSurfaces& train, const PlacedSurfaces& part) {
    train.insert(train.end(), part.begin(), part.end());
}

RayTransfer transfer_of(PlacedSurfaces part) {
    link(part, part.front().pose);
    return transfer_of_train(surfaces_of(part));
}

Surface transfer_between(const Pose& from, const PlacedSurface& to) {
    PlacedSurfaces part = {to};
    link(part, from);
    return part.front().surface;
}

Pose downward(double height) {
    return Pose{}.along_z(height).half_turn();
}

Pose placed_at(const Placement& placement, const Pose& nominal) {
    if (placement.global) {
        Pose corner;
        corner.origin = *placement.global;
        return corner.turned(placement.change);
    }
    return nominal.turned(placement.change);
}

bool has_displaced(const std::vector<Surface>& train) {
    return std::ranges::any_of(train, [](const Surface& surface) { return is_displaced(surface); });
}

void end_in(PlacedSurfaces& train, const PlacedSurface& plane) {
    const Surface to_plane = transfer_between(train.back().pose, plane);
    constexpr double rounding = 1e-12; // mm
    if (is_displaced(to_plane) || std::abs(to_plane.distance) > rounding) {
        train.push_back(plane);
    }
}

PlacedSurfaces plate(const InstrumentDescription& description, const Pose& first, double thickness, const Medium& glass,
                     const Medium& medium, std::optional<double> semi_diameter, const std::string& name) {
    Prescription prescription;
    prescription.name = name;
    prescription.medium_before = medium;
    PrescribedSurface surface;
    surface.semi_diameter = semi_diameter;
    surface.thickness = thickness;
    surface.medium_after = glass;
    prescription.surfaces = {surface, surface};
    prescription.surfaces.back().medium_after = medium;
    Pose end;
    return place_prescription(prescription, description.spectrum, description.interfaces, first, end);
}

PlacedSurface mirror_plane(const SpectralIndex& medium, const Pose& pose, std::optional<double> semi_diameter,
                           std::string what) {
    PlacedSurface mirror = dummy_plane(medium, pose, std::move(what));
    mirror.surface.flags |= physics::f64::SURFACE_MIRROR;
    mirror.surface.reflectance = 1;
    if (semi_diameter) {
        mirror.surface.flags |= physics::f64::SURFACE_CLIPPED;
        mirror.surface.semi_diameter_squared = *semi_diameter * *semi_diameter;
    }
    return mirror;
}

Fold place_fold(const FoldMirror& mirror, const SpectralIndex& air, const Pose& axis) {
    require_positive(mirror.semi_diameter, "fold_mirror.semi_diameter_mm");
    const Pose pose = axis.turned({.tilt_z = mirror.azimuth}).turned({.tilt_x = mirror.incidence});
    Fold fold = {mirror.distance, mirror_plane(air, pose, mirror.semi_diameter, name_of(Part::fold_mirror))};
    fold.mirror.surface.reflectance = mirror.reflectance;
    return fold;
}

std::string distance_key(const InstrumentDescription& description, const FoldMirror& mirror) {
    return fmt::format("fold_mirror[{}].distance_mm", &mirror - description.fold_mirrors.data());
}

} // namespace vkfv::optics
