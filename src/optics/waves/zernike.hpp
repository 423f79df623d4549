// Zernike's polynomials in Noll's order, of unit RMS over the disc (R. J. Noll, J. Opt. Soc. Am. 66 (1976) 207).
#pragma once

#include "optics/waves/wavefront.hpp"

#include <vector>

namespace vkfv::optics {

// Noll's number, from 1: the radial order, the azimuthal one, and whether the angle's factor is a sine.
struct ZernikeOrder {
    int radial = 0;
    int azimuthal = 0;
    bool sine = false;
};
ZernikeOrder zernike_order(int number);

// Z_number at a point of the unit disc.
double zernike(int number, glm::dvec2 at);

// "astigmatism at 45 degrees"; empty for high orders, which have no names.
const char* zernike_name(int number);

// Of a wavefront, in wavelengths, of the numbers 1 to `count`: (1 / pi) times the integral of W Z_j over the unit disc,
// to which the largest disc about the chief ray that lies in the pupil is scaled. The piston is that of W = 0 at the
// chief ray.
std::vector<double> zernike_coefficients(const Wavefront& wavefront, int count);

} // namespace vkfv::optics
