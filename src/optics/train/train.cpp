#include "optics/train/train.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vkfv::optics {

namespace {

using physics::f64::Surface;

double index_at(double centre, const physics::f64::Dispersion& dispersion, double spectral) {
    return centre + physics::f64::disperse(dispersion, spectral);
}

} // namespace

std::string SurfaceName::text() const {
    if (number == 0) {
        return of;
    }
    const char* separator = role == SurfaceRole::refracting ? "" : ", ";
    return fmt::format("{} {}{}{}", of, number, separator, name_of(role));
}

void set_interface(Surface& surface, const Interfaces& interfaces, double layer_index) {
    using namespace physics::f64;
    surface.flags &= ~(SURFACE_FRESNEL | SURFACE_LAYER);
    if (surface.index_before == surface.index_after || (surface.flags & SURFACE_IDEAL_LENS) != 0) {
        return;
    }
    // A coating lies between a glass and air; two cemented glasses meet without one.
    const bool cemented = surface.index_before > 1 && surface.index_after > 1;
    if (interfaces.model == Interfaces::Model::quarter_wave && !cemented) {
        surface.flags |= SURFACE_LAYER;
        surface.layer_index = layer_index;
        surface.layer_thickness = interfaces.design_wavelength_um / (4 * layer_index);
    } else if (interfaces.model != Interfaces::Model::ideal) {
        surface.flags |= SURFACE_FRESNEL;
    }
}

std::vector<PlacedSurface> place_prescription(const Prescription& prescription, const Spectrum& spectrum,
                                              const Interfaces& interfaces, const Pose& first, Pose& end) {
    std::vector<PlacedSurface> part;
    SpectralIndex before = spectral_index(prescription.medium_before, spectrum);
    const double layer_index = interfaces.layer.index(interfaces.design_wavelength_um);
    Pose pose = first;
    for (std::size_t i = 0; i < prescription.surfaces.size(); ++i) {
        const PrescribedSurface& prescribed = prescription.surfaces[i];
        for (const CoordinateBreak& change : prescribed.breaks) {
            pose = pose.after(change);
        }
        const SpectralIndex after = spectral_index(prescribed.medium_after, spectrum);
        PlacedSurface placed;
        placed.pose = pose;
        placed.name = {.of = prescription.name, .number = static_cast<int>(i) + 1, .role = prescribed.role};
        Surface& surface = placed.surface;
        surface.curvature = prescribed.curvature;
        surface.conic = prescribed.conic;
        surface.index_before = before.centre;
        surface.index_after = after.centre;
        surface.dispersion_before = before.dispersion;
        surface.dispersion_after = after.dispersion;
        surface.a4 = prescribed.aspheric[0];
        surface.a6 = prescribed.aspheric[1];
        surface.a8 = prescribed.aspheric[2];
        surface.a10 = prescribed.aspheric[3];
        surface.a12 = prescribed.aspheric[4];
        surface.a14 = prescribed.aspheric[5];
        surface.a16 = prescribed.aspheric[6];
        if (std::ranges::any_of(prescribed.aspheric, [](double coefficient) { return coefficient != 0; })) {
            surface.flags |= physics::f64::SURFACE_ASPHERIC;
        }
        if (prescribed.semi_diameter) {
            surface.semi_diameter_squared = *prescribed.semi_diameter * *prescribed.semi_diameter;
            surface.flags |= physics::f64::SURFACE_CLIPPED;
        }
        if (prescribed.ideal_power) {
            surface.power = *prescribed.ideal_power;
            surface.flags |= physics::f64::SURFACE_IDEAL_LENS;
        }
        set_interface(surface, interfaces, layer_index);
        part.push_back(std::move(placed));
        before = after;
        end = pose;
        pose = pose.along_z(prescribed.thickness);
    }
    return part;
}

std::vector<PlacedSurface> reversed(const std::vector<PlacedSurface>& part) {
    std::vector<PlacedSurface> result(part.rbegin(), part.rend());
    for (PlacedSurface& placed : result) {
        Surface& surface = placed.surface;
        placed.pose = placed.pose.half_turn();
        surface.curvature = -surface.curvature;
        for (double* coefficient :
             {&surface.a4, &surface.a6, &surface.a8, &surface.a10, &surface.a12, &surface.a14, &surface.a16}) {
            *coefficient = -*coefficient;
        }
        std::swap(surface.index_before, surface.index_after);
        std::swap(surface.dispersion_before, surface.dispersion_after);
        if ((surface.flags & physics::f64::SURFACE_LIGHT_FIELD) != 0) {
            surface.flags ^= physics::f64::SURFACE_TURNED;
        }
    }
    return result;
}

PlacedSurface dummy_plane(const SpectralIndex& medium, const Pose& pose, std::string what) {
    PlacedSurface placed;
    placed.surface.index_before = placed.surface.index_after = medium.centre;
    placed.surface.dispersion_before = placed.surface.dispersion_after = medium.dispersion;
    placed.pose = pose;
    placed.name.of = std::move(what);
    return placed;
}

void link(std::vector<PlacedSurface>& train, const Pose& entry) {
    // Transfers that differ from the identity by less are rounding, which would make every train look displaced.
    constexpr double rounding = 1e-12;
    const auto snapped = [](double value, double to) { return std::abs(value - to) < rounding ? to : value; };
    const Pose* previous = &entry;
    for (PlacedSurface& placed : train) {
        Surface& surface = placed.surface;
        const glm::dmat3 back = glm::transpose(previous->axes);
        const glm::dvec3 shift = back * (placed.pose.origin - previous->origin);
        const glm::dmat3 rotation = glm::transpose(placed.pose.axes) * previous->axes; // columns: old axes
        surface.decentre_x = snapped(shift.x, 0);
        surface.decentre_y = snapped(shift.y, 0);
        surface.distance = shift.z;
        surface.rotation_xx = snapped(rotation[0][0], 1);
        surface.rotation_yx = snapped(rotation[0][1], 0);
        surface.rotation_zx = snapped(rotation[0][2], 0);
        surface.rotation_xy = snapped(rotation[1][0], 0);
        surface.rotation_yy = snapped(rotation[1][1], 1);
        surface.rotation_zy = snapped(rotation[1][2], 0);
        surface.rotation_xz = snapped(rotation[2][0], 0);
        surface.rotation_yz = snapped(rotation[2][1], 0);
        surface.rotation_zz = snapped(rotation[2][2], 1);
        previous = &placed.pose;
    }
}

bool is_displaced(const Surface& surface) {
    return surface.decentre_x != 0 || surface.decentre_y != 0 || surface.rotation_xx != 1 || surface.rotation_yy != 1 ||
           surface.rotation_zz != 1;
}

std::vector<Surface> surfaces_of(const std::vector<PlacedSurface>& train) {
    std::vector<Surface> surfaces;
    surfaces.reserve(train.size());
    for (const PlacedSurface& placed : train) {
        surfaces.push_back(placed.surface);
    }
    return surfaces;
}

std::optional<std::size_t> surface_with_role(const std::vector<PlacedSurface>& part, SurfaceRole role) {
    const auto found = std::ranges::find(part, role, [](const PlacedSurface& placed) { return placed.name.role; });
    return found == part.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - part.begin()));
}

glm::dvec2 meeting_place(const Surface& surface, const physics::f64::TrainResult& before,
                         const physics::f64::TrainResult& behind, const physics::f64::Light& light,
                         std::uint32_t present) {
    if ((surface.flags & physics::f64::SURFACE_IDEAL_LENS) == 0) {
        return glm::dvec2(behind.ray.position);
    }
    // The ray is traced to the lens as a plane without power, which it meets at the same place.
    const std::uint32_t plane = present & ~physics::f64::FEATURE_IDEAL_LENS;
    return glm::dvec2(physics::f64::trace_surface(surface, 0, before, false, light, plane).ray.position);
}

namespace {

// most_excess: the largest excess_of() over the edges met; null if not wanted. One function serves both callers, so
// that the compiler puts each surface's work into its loop.
physics::f64::TrainResult go_through(std::span<const Surface> train, physics::f64::Ray ray, bool apertures,
                                     double spectral, double* most_excess) {
    const double index =
        train.empty() ? 1 : index_at(train.front().index_before, train.front().dispersion_before, spectral);
    ray.direction *= index;
    const physics::f64::Light light{.spectral = spectral, .wave_number = 1, .survival = 0};
    physics::f64::TrainResult result = physics::f64::enter_train(ray, index);
    // Only the features that the surface has are computed; the others would change no bit.
    for (std::size_t i = 0; i < train.size() && result.status == physics::f64::PATH_ALIVE; ++i) {
        const Surface& surface = train[i];
        const std::uint32_t present =
            (is_displaced(surface) ? physics::f64::FEATURE_PLACEMENT : 0u) |
            (spectral != 0 ? physics::f64::FEATURE_SPECTRUM : 0u) |
            ((surface.flags & physics::f64::SURFACE_IDEAL_LENS) != 0 ? physics::f64::FEATURE_IDEAL_LENS : 0u);
        const physics::f64::TrainResult before = result;
        result = physics::f64::trace_surface(surface, static_cast<int>(i), before, apertures, light, present);
        if (most_excess != nullptr && (surface.flags & physics::f64::SURFACE_CLIPPED) != 0) {
            const glm::dvec2 place = meeting_place(surface, before, result, light, present);
            *most_excess = std::max(*most_excess, (glm::dot(place, place) - surface.semi_diameter_squared) /
                                                      surface.semi_diameter_squared);
        }
    }
    return result;
}

} // namespace

physics::f64::TrainResult trace_through(std::span<const Surface> train, physics::f64::Ray ray, std::uint32_t apertures,
                                        double spectral) {
    return go_through(train, ray, apertures != 0u, spectral, nullptr);
}

double excess_of(std::span<const Surface> train, const physics::f64::Ray& ray, double spectral) {
    double most = -1;
    const auto status = go_through(train, ray, true, spectral, &most).status;
    const bool measured = status == physics::f64::PATH_ALIVE || status == physics::f64::PATH_VIGNETTED;
    return measured ? most : std::numeric_limits<double>::infinity();
}

} // namespace vkfv::optics
