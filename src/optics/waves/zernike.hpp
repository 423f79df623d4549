// Zernike's polynomials in Noll's order, of unit RMS over the disc (R. J. Noll, J. Opt. Soc. Am. 66 (1976) 207).
#pragma once

#include "optics/waves/wavefront.hpp"

#include <vector>

namespace vkfv::optics {

// The orders of a Zernike polynomial: radial, azimuthal, and whether its angular factor is a sine. `number` is Noll's,
// from 1.
struct ZernikeOrder {
    int radial = 0;
    int azimuthal = 0;
    bool sine = false;
};
ZernikeOrder zernike_order(int number);

// Z_number at a point of the unit disc.
double zernike(int number, glm::dvec2 at);

// The aberration's name, such as "astigmatism at 45 degrees"; empty for high orders, which have no names.
const char* zernike_name(int number);

// Noll's coefficients 1 to `count` of a wavefront, in wavelengths: (1 / pi) times the integral of W Z_j over the unit
// disc, which stands for the largest disc about the chief ray within the pupil. The piston is relative to W = 0 at the
// chief ray.
std::vector<double> zernike_coefficients(const Wavefront& wavefront, int count);

} // namespace vkfv::optics
