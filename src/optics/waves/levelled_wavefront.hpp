// A wavefront without piston and tilt, which shift its image but do not blur it.
#pragma once

#include "optics/waves/point_waves.hpp"
#include "optics/waves/wavefront.hpp"

namespace vkfv::optics {

// The plane piston + tilt . (p - chief) nearest to W over the pupil in the least-squares sense, and the RMS of the
// remainder.
struct LevelledWavefront {
    double piston = 0;  // mm
    glm::dvec2 tilt{0}; // mm, as p has no unit
    double rms = 0;     // mm, remainder over the pupil
};

// Fits the plane by quadrature over the whole pupil, vignetted or not. Areas in p have equal weight, as equal areas
// pass equal flux of a Lambertian specimen. All members are 0 if no light passes.
LevelledWavefront levelled(const Wavefront& wavefront);

// The wavefront quality of the image of a point of the field, at z = 0. Both members are NaN if no light passes.
struct WavefrontQuality {
    // The RMS at the wavelength in the middle of the flux, in waves: piston and tilt are removed, defocus is not.
    double rms = 0;
    // The ratio of the irradiance at the centre of the best-fitting tilt to that without aberrations: |<exp(2 pi i W /
    // lambda)>|^2 (Born and Wolf, "Principles of Optics", section 9.1), over the spectrum weighted by flux / lambda^2.
    double strehl = 0;
};
WavefrontQuality wavefront_quality(const PointWaves& waves);
// Traces the wavefronts of a point of the field (mm in the object) and measures their quality.
WavefrontQuality wavefront_quality(const Instrument& instrument, glm::dvec2 field);

} // namespace vkfv::optics
