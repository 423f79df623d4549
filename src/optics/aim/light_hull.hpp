// The greatest extent of all light that starts from a disc and passes a train, over places, directions and wavelengths,
// found by an adversary that searches for light further out. Lengths in mm.
#pragma once

#include "optics/train/affine.hpp"
#include "physics/physics.hpp"

#include <glm/glm.hpp>

#include <functional>
#include <span>

namespace vkfv::optics {

// Light from a disc about the axis through a train. Slopes are dx/dz and dy/dz.
struct DiscLight {
    std::span<const physics::f64::Surface> train;
    double radius = 0;
    Range distance; // distances of the disc in front of the frame in which light enters the train
    Range spectral; // x of physics::Light
    // The expected light from a place of the disc has the slope middle + towards * place (`towards` in 1/mm) and lies
    // within about `reach` of that, in slope.
    glm::dvec2 middle{0};
    double towards = 0;
    double reach = 1;
    bool symmetric = true;
};

// A ray that passes the train: its start in the disc, and its end in the frame of the train's last surface.
struct PassingRay {
    glm::dvec2 start{0};
    glm::dvec2 start_slope{0};
    double distance = 0; // distance of the disc where the ray starts
    glm::dvec2 end{0};   // position in the plane z = 0
    glm::dvec2 end_slope{0};
};
using RayMeasure = std::function<double(const PassingRay&)>;

// The rays of one place and wavelength to be searched: those on the rim of the passing cone, or all. The rim is enough
// for a measure that has no maximum within a cone, such as the distance from a point when the cone is imaged
// one-to-one.
enum class ConePart { rim, whole };

// An upper bound of a measure over all rays that pass; 0 if none passes. From the greatest value on a grid of places,
// azimuths and wavelengths, at each wavelength of the grid, an adversary climbs by random steps of decreasing size. The
// result is rounded up by 0.3 to 0.7 %, so that machines whose libraries round differently agree. A thin cone that no
// grid point meets may be missed. measure: >= 0, continuous; called by several threads at once.
double greatest_of(const DiscLight& light, ConePart part, const RayMeasure& measure);

} // namespace vkfv::optics
