// How far all light reaches that starts from a disc and passes a train: over places, directions and wavelengths, found
// by an adversary that looks for light further out. Lengths in mm.
#pragma once

#include "optics/train/affine.hpp"
#include "physics/physics.hpp"

#include <glm/glm.hpp>

#include <functional>
#include <span>

namespace vkfv::optics {

// Light from a disc about the axis, on its way through a train. Slopes are dx/dz and dy/dz.
struct DiscLight {
    std::span<const physics::f64::Surface> train;
    double radius = 0;
    Range distance; // of the disc in front of the frame that the train is entered in
    Range spectral; // x of physics::Light
    // From a place of the disc light is looked for about the slope middle + towards * place (1/mm), and first as far
    // from there as about `reach`, in slope.
    glm::dvec2 middle{0};
    double towards = 0;
    double reach = 1;
    bool symmetric = true;
};

// A ray of it that passes: where it starts, in the disc, and where it ends, in the frame of the train's last surface.
struct PassingRay {
    glm::dvec2 start{0};
    glm::dvec2 start_slope{0};
    double distance = 0; // of the disc that it starts from
    glm::dvec2 end{0};   // in the plane z = 0
    glm::dvec2 end_slope{0};
};
using RayMeasure = std::function<double(const PassingRay&)>;

// Which of the rays that leave one place in one wavelength: those on the rims of what passes, or all of them. The rims
// are enough for a measure that has no greatest value within a cone, as the distance from a point has none of what is
// a one-to-one image of the cone.
enum class ConePart { rim, whole };

// No ray has a greater measure; 0 if nothing passes. From the greatest that is found on a grid of places, azimuths and
// wavelengths, at each wavelength of the grid, an adversary climbs on, by random steps of ever smaller size. The result
// is rounded up by 0.3 to 0.7 %, so that machines whose libraries round otherwise agree. A thin cone beside all that
// the grid meets may be missed. measure: >= 0, continuous; called by several threads at once.
double greatest_of(const DiscLight& light, ConePart part, const RayMeasure& measure);

} // namespace vkfv::optics
