// A wavefront without what moves its image and does not blur it.
#pragma once

#include "optics/waves/point_waves.hpp"
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

// Commands tell these of the image of a point of the field, at z = 0. Both are NaN where no light passes.
struct WavefrontQuality {
    // This RMS is that of the wavelength in the middle of the flux, in waves: piston and tilt are removed, defocus is
    // not.
    double rms = 0;
    // The ratio of the irradiance at the centre of the best-fitting tilt to that without aberrations: |<exp(2 pi i W /
    // lambda)>|^2 (Born and Wolf, "Principles of Optics", section 9.1), over the spectrum weighted by flux / lambda^2.
    double strehl = 0;
};
WavefrontQuality wavefront_quality(const PointWaves& waves);
// field: mm in the object.
WavefrontQuality wavefront_quality(const Instrument& instrument, glm::dvec2 field);

} // namespace vkfv::optics
