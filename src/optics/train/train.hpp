// Prescriptions as surfaces that stand somewhere, and the trains of them that light goes through in sequence.
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

// What refracting interfaces reflect.
struct Interfaces {
    enum class Model { ideal, fresnel, quarter_wave } model = Model::ideal;
    // Of the quarter-wave layer at normal incidence.
    Medium layer = Medium::air();
    double design_wavelength_um = 0.55;
};

// What a surface is; only text() makes words of it.
struct SurfaceName {
    std::string of; // the prescription's name, or what stands there: "fold mirror"
    int number = 0; // in the prescription, from 1; 0: it is of none
    SurfaceRole role = SurfaceRole::refracting;
    std::string text() const; // "10x_0.28 3, aperture stop"
    bool operator==(const SurfaceName&) const = default;
};

// A surface as the trace takes it, in the direction of the light, and where it stands.
struct PlacedSurface {
    physics::f64::Surface surface{}; // its transfer from the previous vertex is set by link()
    Pose pose;
    SurfaceName name;
};

// The surfaces of a prescription, with the first vertex (before its coordinate breaks) at `first`. `end` becomes the
// last vertex's frame.
std::vector<PlacedSurface> place_prescription(const Prescription& prescription, const Spectrum& spectrum,
                                              const Interfaces& interfaces, const Pose& first, Pose& end);

// Light the other way: the order, each surface and its frame are turned round.
std::vector<PlacedSurface> reversed(const std::vector<PlacedSurface>& part);

// An unbounded plane without effect, between equal media: where a train begins or ends in a frame of its own.
PlacedSurface dummy_plane(const SpectralIndex& medium, const Pose& pose, std::string what);

// Sets each surface's transfer from the one before, the first one's from `entry`.
void link(std::vector<PlacedSurface>& train, const Pose& entry);

// Whether a transfer is more than a distance along z.
bool is_displaced(const physics::f64::Surface& surface);

std::vector<physics::f64::Surface> surfaces_of(const std::vector<PlacedSurface>& train);

// Marks an interface between different media with what it reflects; between equal media it clears the mark.
void set_interface(physics::f64::Surface& surface, const Interfaces& interfaces, double layer_index);

std::optional<std::size_t> surface_with_role(const std::vector<PlacedSurface>& part, SurfaceRole role);

// What the plane of the illumination's field stop lets through, in the frame of that surface.
struct LightField {
    physics::f64::LightField record{};
    Grid<float> points{}; // of a pattern with a grid
};

// The scene that physics::trace_train needs on the host: monochromatic light unless bins are given.
struct TrainScene {
    std::span<const physics::f64::Surface> surfaces;
    std::uint32_t present = physics::f64::FEATURE_PLACEMENT | physics::f64::FEATURE_LOSSES |
                            physics::f64::FEATURE_SPECTRUM | physics::f64::FEATURE_IDEAL_LENS;
    std::span<const physics::f64::SpectralBin> bins{};
    const LightField* field = nullptr; // only with FEATURE_LIGHT_FIELD

    const physics::f64::Surface& surface_at(int index) const { return surfaces[static_cast<std::size_t>(index)]; }
    std::uint32_t features() const { return present; }
    const physics::f64::SpectralBin& spectral_bin(int index) const { return bins[static_cast<std::size_t>(index)]; }
    const physics::f64::LightField& light_field() const { return field->record; }
    double pattern_point(const physics::f64::Pattern& /*the light's*/, int column, int row) const {
        return static_cast<double>(field->points(column, row));
    }
};

// Where light met a surface, in the surface's frame. `behind` is what trace_surface() made of `before`, of all that is
// `present`: an ideal lens puts the ray on its focal plane.
glm::dvec2 meeting_place(const physics::f64::Surface& surface, const physics::f64::TrainResult& before,
                         const physics::f64::TrainResult& behind, const physics::f64::Light& light,
                         std::uint32_t present);

// Through the whole train, from the entry's frame to the last vertex's. ray.direction is a unit vector; nothing is lost
// at interfaces. spectral: x of physics::Light. A ray that ends is traced no further than to the surface where it does.
physics::f64::TrainResult trace_through(std::span<const physics::f64::Surface> train, physics::f64::Ray ray,
                                        std::uint32_t apertures, double spectral = 0);

// By how much of the square of an edge's radius the ray is beyond the edge that stops it, or, at or below 0, short of
// the edge that it comes nearest to. Infinite: it ends elsewhere. <= 0 is what PATH_ALIVE is to trace_through().
double excess_of(std::span<const physics::f64::Surface> train, const physics::f64::Ray& ray, double spectral = 0);

} // namespace vkfv::optics
