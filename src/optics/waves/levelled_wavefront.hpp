// A wavefront without what moves its image and does not blur it.
#pragma once

#include "optics/waves/wavefront.hpp"

namespace vkfv::optics {

// The plane piston + tilt . (p - chief) that is nearest to W over the pupil in the mean square, and what is left of W.
struct LevelledWavefront {
    double piston = 0;  // mm
    glm::dvec2 tilt{0}; // mm, as p has no unit
    double rms = 0;     // mm, of the rest over the pupil
};

// By quadrature over the whole pupil, vignetted or not, of equal areas in p, which equal flux of a Lambertian specimen
// passes. All 0 where no light passes.
LevelledWavefront levelled(const Wavefront& wavefront);

} // namespace vkfv::optics
