// Bundles of rays: all rays of a disc source whose positions, directions and wavelengths lie in a box, traced through a
// train at once to prove that none of them passes. Lengths in mm, angles in rad.
#pragma once

#include "optics/affine.hpp"
#include "physics/physics.hpp"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace vkfv::optics {

// The coordinates of a ray of a disc source: indices into EmissionBox and Affine::slopes.
enum EmissionCoordinate : std::size_t {
    from_axis,   // mm, its start
    polar_angle, // rad, its direction against the normal
    azimuth,     // rad, of its direction, against that of its start
    turn,        // rad, of both about the normal
    spectral,    // x of physics::Light
};

using EmissionBox = std::array<Range, Affine::coordinates>;

// A ray in the source's frame, starting on z = 0. `at`: its place in the box, each coordinate in [-1, 1].
struct EmittedRay {
    physics::f64::Ray ray;
    double spectral = 0;
};
EmittedRay ray_in(const EmissionBox& box, const std::array<double, Affine::coordinates>& at);

// An aperture (mm), and the heights in the surface's frame at which light can meet the surface within it: about its
// vertex, and on a conic's other side, beyond the equator or on the other sheet. Aspheres have none.
struct ApertureBounds {
    double radius = 0;
    Range heights;
    std::optional<Range> far_heights;
};

class BundleTracer {
  public:
    // `train` as in trace_through, entered source_distance behind the source; it must outlive this.
    BundleTracer(std::span<const physics::f64::Surface> train, double source_distance);

    // None: it is proved that no ray of the box passes the whole train. The proof uses the equations of the trace
    // (physics/train.glsl) with apertures, total reflection and missed surfaces, but not losses at interfaces.
    // Otherwise some rays may pass, and the result is the coordinate in which halving the box tells most.
    std::optional<EmissionCoordinate> may_pass(const EmissionBox& box) const;

  private:
    std::span<const physics::f64::Surface> train_;
    double source_distance_;
    std::vector<std::optional<ApertureBounds>> apertures_; // none: unbounded
    std::size_t first_displaced_;                          // before it, turning a ray about the normal changes nothing
};

} // namespace vkfv::optics
