// Bundles of rays: all rays of a disc source whose positions, directions and wavelengths lie in a box, traced through a
// train at once to prove that none of them passes. Lengths in mm, angles in rad.
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
    from_axis,   // mm, its start
    from_middle, // distance of its direction's cosines across the normal from their middle
    azimuth,     // rad, of that offset, against that of its start
    turn,        // rad, of both about the normal
    spectral,    // x of physics::Light
};

using EmissionBox = std::array<Range, Affine::coordinates>;

// The directions that are asked about, by their cosines across the normal: counted from `shift` (1/mm) times the place
// at the source; what is farther than `reach` from the normal is left out.
struct EmissionMiddle {
    double shift = 0;
    double reach = 1;
};

// A ray in the source's frame, starting on z = 0. `at`: its place in the box, each coordinate in [-1, 1]. None: what is
// there is no direction, or beyond reach.
struct EmittedRay {
    physics::f64::Ray ray;
    double spectral = 0;
};
std::optional<EmittedRay> ray_in(const EmissionBox& box, const EmissionMiddle& middle,
                                 const std::array<double, Affine::coordinates>& at);

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
    BundleTracer(std::span<const physics::f64::Surface> train, double source_distance,
                 const EmissionMiddle& middle = {});

    // None: it is proved that no ray of the box, within reach, passes the whole train. The proof uses the equations of
    // the trace (physics/train.glsl) with apertures, total reflection and missed surfaces, but not losses at
    // interfaces. Otherwise some rays may pass, and the result is the coordinate in which halving the box tells most.
    std::optional<EmissionCoordinate> may_pass(const EmissionBox& box) const;

  private:
    std::span<const physics::f64::Surface> train_;
    double source_distance_;
    EmissionMiddle middle_;
    std::vector<std::optional<ApertureBounds>> apertures_; // none: unbounded
    std::size_t first_displaced_;                          // before it, turning a ray about the normal changes nothing
};

} // namespace vkfv::optics
