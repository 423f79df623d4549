// The best focus of an instrument, from wavefronts.
#pragma once

#include "optics/aim/apertures.hpp"
#include "optics/media/spectrum.hpp"

#include <span>

namespace vkfv::optics {

// The place in focus at one point of the detector, where that point's light leaves the specimen.
struct PencilFocus {
    // The height (mm) of best_focus() above the paraxial object plane. NaN if no light arrives.
    double height = 0;
    // The mean position (mm) in the plane at that height over pupil and spectrum, weighted by flux. Light of uniform
    // radiance sends the same flux through equal areas of the pupil in direction cosines times the index, except for
    // the change of the local magnification over the pupil, which is of the order of the transverse aberration over the
    // field.
    glm::dvec2 centroid = glm::dvec2(0);
};

// The focus of the pencil that reaches a point of the detector (mm, frame of Imaging::Landing). outline: of the light
// from near that point's image.
PencilFocus focus_of_pencil(const Imaging& imaging, double magnification, const Outline& outline, glm::dvec2 detector,
                            std::span<const SpectralNode> spectrum);

// The height (mm) above the paraxial object plane at which the wavefront of the outline's light has the least variance
// over pupil and spectrum, in wavelengths and weighted by flux. Piston and tilt of each wavelength, which shift no
// focus, are left out. Raising the plane by z adds z sqrt(n^2 - p^2) to W (wavefront.hpp), so the height follows from a
// linear fit. NaN if no light arrives. Near this height the contrast of all but the finest waves is highest (Born and
// Wolf, "Principles of Optics", section 9.3).
double best_focus(const Imaging& imaging, double magnification, const Outline& outline,
                  std::span<const SpectralNode> spectrum);

} // namespace vkfv::optics
