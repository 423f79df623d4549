// Bundles of rays: all rays of a disc source whose positions, directions and wavelengths lie in a box are traced
// through a train at once, to prove that none of them passes. Lengths in mm, angles in rad.
#pragma once

#include "optics/train/affine.hpp"
#include "physics/physics.hpp"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace vkfv::optics {

// The coordinates of a ray of a disc source: indices into EmissionBox and Affine::slopes.
enum EmissionCoordinate : std::size_t {
    from_axis,   // mm, distance of the starting point from the source's axis
    from_middle, // distance of the transverse direction cosines from their middle (EmissionMiddle)
    azimuth,     // rad, azimuth of that distance relative to the azimuth of the starting point
    turn,        // rad, rotation of starting point and direction about the normal
    spectral,    // spectral coordinate x of physics::Light
};

using EmissionBox = std::array<Range, Affine::coordinates>;

// The middle of the directions under test, in direction cosines transverse to the normal: `shift` (1/mm) times the
// position on the source. Directions farther than `reach` from the normal are left out.
struct EmissionMiddle {
    double shift = 0;
    double reach = 1;
};

// The ray at a place in the box, in the source's frame, starting on z = 0. `at`: coordinates in the box, each in [-1,
// 1]. None if they give no direction, or one beyond `reach`.
struct EmittedRay {
    physics::f64::Ray ray;
    double spectral = 0;
};
std::optional<EmittedRay> ray_in(const EmissionBox& box, const EmissionMiddle& middle,
                                 const std::array<double, Affine::coordinates>& at);

// The radius of an aperture (mm), and the heights in the surface's frame at which light can meet the surface within it:
// near the vertex, and on a conic's other side, beyond the equator or on the other sheet. Aspheres have no far heights.
struct ApertureBounds {
    double radius = 0;
    Range heights;
    std::optional<Range> far_heights;
};

class BundleTracer {
  public:
    // `train`: as in trace_through(), entered source_distance behind the source; the caller keeps it alive.
    BundleTracer(std::span<const physics::f64::Surface> train, double source_distance,
                 const EmissionMiddle& middle = {});

    // No value if it is proved that no ray of the box, within reach, passes the whole train. The proof uses the
    // equations of the trace (physics/train.glsl) with apertures, total reflection and missed surfaces, but not losses
    // at interfaces. Otherwise some rays may pass, and the result is the coordinate along which halving the box helps
    // most.
    std::optional<EmissionCoordinate> may_pass(const EmissionBox& box) const;

  private:
    std::span<const physics::f64::Surface> train_;
    double source_distance_;
    EmissionMiddle middle_;
    std::vector<std::optional<ApertureBounds>> apertures_; // none: unbounded
    std::size_t first_displaced_;                          // up to here rotating a ray about the normal changes nothing
};

} // namespace vkfv::optics
