// Prescriptions as placed surfaces, and the trains of surfaces that light passes in sequence.
#pragma once

#include "core/mathematics/grid.hpp"
#include "optics/media/spectrum.hpp"
#include "optics/prescriptions/pose.hpp"
#include "optics/prescriptions/prescription.hpp"
#include "physics/physics.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace vkfv::optics {

// The reflection of refracting interfaces.
struct Interfaces {
    enum class Model { ideal, fresnel, quarter_wave } model = Model::ideal;
    // The medium of the quarter-wave layer at normal incidence.
    Medium layer = Medium::air();
    double design_wavelength_um = 0.55;
};

// The name of a surface in parts; text() joins them.
struct SurfaceName {
    std::string of; // name of the prescription, or of the part: "fold mirror"
    int number = 0; // number in the prescription, from 1; 0: in no prescription
    SurfaceRole role = SurfaceRole::refracting;
    std::string text() const; // for example "10x_0.28 3, aperture stop"
    bool operator==(const SurfaceName&) const = default;
};

// A surface as the trace takes it, in the direction of the light, and its pose.
struct PlacedSurface {
    physics::f64::Surface surface{}; // link() sets its transfer from the previous vertex
    Pose pose;
    SurfaceName name;
};

// Places the surfaces of a prescription; `first` is the frame of the first vertex before its coordinate breaks. Sets
// `end` to the last vertex's frame.
std::vector<PlacedSurface> place_prescription(const Prescription& prescription, const Spectrum& spectrum,
                                              const Interfaces& interfaces, const Pose& first, Pose& end);

// The train for light of opposite direction: the order, each surface and its frame are reversed.
std::vector<PlacedSurface> reversed(const std::vector<PlacedSurface>& part);

// An unbounded plane without effect, between equal media, at which a train begins or ends in a frame of its own.
PlacedSurface dummy_plane(const SpectralIndex& medium, const Pose& pose, std::string what);

// Sets each surface's transfer from the previous one; that of the first starts at `entry`.
void link(std::vector<PlacedSurface>& train, const Pose& entry);

// True if a transfer is more than a distance along z.
bool is_displaced(const physics::f64::Surface& surface);

std::vector<physics::f64::Surface> surfaces_of(const std::vector<PlacedSurface>& train);

// Sets the reflection of an interface between different media; clears it between equal media.
void set_interface(physics::f64::Surface& surface, const Interfaces& interfaces, double layer_index);

std::optional<std::size_t> surface_with_role(const std::vector<PlacedSurface>& part, SurfaceRole role);

// The transmission of the plane of the illumination's field stop, in the frame of that surface.
struct LightField {
    physics::f64::LightField record{};
    Grid<float> points{}; // grid of a pattern that has one
};

// The scene that physics::trace_train needs on the host: monochromatic light unless bins are given.
struct TrainScene {
    std::span<const physics::f64::Surface> surfaces;
    std::uint32_t present = physics::f64::FEATURE_PLACEMENT | physics::f64::FEATURE_LOSSES |
                            physics::f64::FEATURE_SPECTRUM | physics::f64::FEATURE_IDEAL_LENS;
    std::span<const physics::f64::SpectralBin> bins{};
    const LightField* field = nullptr; // set only with FEATURE_LIGHT_FIELD

    const physics::f64::Surface& surface_at(int index) const { return surfaces[static_cast<std::size_t>(index)]; }
    std::uint32_t features() const { return present; }
    const physics::f64::SpectralBin& spectral_bin(int index) const { return bins[static_cast<std::size_t>(index)]; }
    const physics::f64::LightField& light_field() const { return field->record; }
    double pattern_point(const physics::f64::Pattern& /*the light's*/, int column, int row) const {
        return static_cast<double>(field->points(column, row));
    }
};

// The place where light met a surface (mm, in the surface's frame). `behind` is the result of trace_surface() on
// `before` with the features `present`; its own place does not serve, as an ideal lens moves the ray to its focal
// plane.
glm::dvec2 meeting_place(const physics::f64::Surface& surface, const physics::f64::TrainResult& before,
                         const physics::f64::TrainResult& behind, const physics::f64::Light& light,
                         std::uint32_t present);

// Traces a ray through the whole train, from the entry's frame to the last vertex's. ray.direction is a unit vector;
// interfaces cause no losses. spectral: x of physics::Light. A ray that ends is traced only to the surface where it
// does.
physics::f64::TrainResult trace_through(std::span<const physics::f64::Surface> train, physics::f64::Ray ray,
                                        std::uint32_t apertures, double spectral = 0);

// The excess of a ray's squared distance from the axis over an edge's squared radius, as a share of the latter, at the
// edge that stops the ray; at or below 0, at the edge that it comes nearest to. Infinite if the ray ends for another
// reason. A value <= 0 is equivalent to PATH_ALIVE of trace_through().
double excess_of(std::span<const physics::f64::Surface> train, const physics::f64::Ray& ray, double spectral = 0);

} // namespace vkfv::optics
