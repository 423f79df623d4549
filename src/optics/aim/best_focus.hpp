// Where an instrument is in focus, by waves.
#pragma once

#include "optics/aim/apertures.hpp"
#include "optics/media/spectrum.hpp"

#include <span>

namespace vkfv::optics {

// Height above the paraxial object plane, mm, at which the wavefront of the outline's light has the least variance over
// pupil and spectrum, in wavelengths and weighted by flux; piston and tilt, which move no focus, are left out for each
// wavelength. Raising the plane by z adds z sqrt(n^2 - p^2) to W (wavefront.hpp), so it is a linear fit. NaN where no
// light arrives. About there the contrast of all but the finest waves is highest (Born and Wolf, "Principles of
// Optics", section 9.3).
double best_focus(const Imaging& imaging, double magnification, const Outline& outline,
                  std::span<const SpectralNode> spectrum);

} // namespace vkfv::optics
