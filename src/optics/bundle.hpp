// Bundles: all rays that a box of a disc source's positions, directions and wavelengths holds, led through a train at
// once, to prove that none of them passes. Lengths in mm, angles in rad.
#pragma once

#include "optics/affine.hpp"
#include "physics/physics.hpp"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace vkfv::optics {

// What a ray of a disc source is told by, as places in EmissionBox and Affine::slopes.
enum EmissionCoordinate : std::size_t {
    from_axis,   // mm, its start
    polar_angle, // rad, its direction against the normal
    azimuth,     // rad, of its direction, against that of its start
    turn,        // rad, of both about the normal
    spectral,    // x of physics::Light
};

using EmissionBox = std::array<Range, Affine::coordinates>;

// In the source's frame, starting on z = 0. `at` is a place of the box, each in [-1, 1].
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

    // None: no ray of the box passes all of the train, by the rays' own equations (physics/train.glsl) with apertures,
    // total reflection and surfaces that are missed; losses at interfaces are not looked at. Else some may, and the
    // coordinate that the box is best halved in to know more.
    std::optional<EmissionCoordinate> may_pass(const EmissionBox& box) const;

  private:
    std::span<const physics::f64::Surface> train_;
    double source_distance_;
    std::vector<std::optional<ApertureBounds>> apertures_; // none: unbounded
    std::size_t first_displaced_;                          // up to there the turn about the normal does not matter
};

} // namespace vkfv::optics
