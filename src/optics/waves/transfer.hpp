// The wave-optical transfer function at one wavelength, integrated over the traced pupil, without Fourier transforms or
// pupil cells. It holds for incoherent light, scalar waves, and a pupil of uniform radiance in direction cosines (a
// Lambertian specimen's).
#pragma once

#include "optics/waves/wavefront.hpp"

#include <complex>

namespace vkfv::optics {

// Hopkins' transfer function (Proc. Roy. Soc. A 231 (1955) 91) at a frequency in cycles per mm of the object, with the
// pupil's area A:
//   H(f) = (1 / A) integral of exp(-i k (W(p + lambda f / 2) - W(p - lambda f / 2))) over the p of which both pass.
// H(f) is the integral of the point spread times exp(-2 pi i f . x), 1 at 0. Pupils are assumed convex.
std::complex<double> transfer(const Wavefront& wavefront, glm::dvec2 frequency);

} // namespace vkfv::optics
