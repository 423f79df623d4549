// Where an instrument is in focus, by waves.
#pragma once

#include "optics/aim/apertures.hpp"
#include "optics/media/spectrum.hpp"

#include <span>

namespace vkfv::optics {

// The light that arrives at one point of the detector, where it leaves what is in focus there.
struct PencilFocus {
    // Above the paraxial object plane, mm: see best_focus(). NaN where no light arrives.
    double height = 0;
    // In the plane at that height, mm: the mean place over pupil and spectrum, weighted by flux. Light of uniform
    // radiance sends the same flux through equal areas of the pupil in direction cosines times the index, but for the
    // change of the local magnification over the pupil, which is of the order of the transverse aberration over the
    // field.
    glm::dvec2 centroid = glm::dvec2(0);
};

// Of a point of the detector (mm, frame of Imaging::Landing). outline: of the light from about where its image lies.
PencilFocus focus_of_pencil(const Imaging& imaging, double magnification, const Outline& outline, glm::dvec2 detector,
                            std::span<const SpectralNode> spectrum);

// Height above the paraxial object plane, mm, at which the wavefront of the outline's light has the least variance over
// pupil and spectrum, in wavelengths and weighted by flux; piston and tilt, which move no focus, are left out for each
// wavelength. Raising the plane by z adds z sqrt(n^2 - p^2) to W (wavefront.hpp), so it is a linear fit. NaN where no
// light arrives. About there the contrast of all but the finest waves is highest (Born and Wolf, "Principles of
// Optics", section 9.3).
double best_focus(const Imaging& imaging, double magnification, const Outline& outline,
                  std::span<const SpectralNode> spectrum);

} // namespace vkfv::optics
