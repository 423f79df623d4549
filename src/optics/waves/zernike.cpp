#include "optics/waves/zernike.hpp"

#include "core/mathematics/units.hpp"
#include "optics/waves/quadrature.hpp"

#include <array>
#include <cmath>
#include <cstdlib>

namespace vkfv::optics {

ZernikeOrder zernike_order(int number) {
    int radial = 0;
    int left = number - 1;
    while (left > radial) {
        left -= ++radial;
    }
    // Within an order, terms come in pairs of rising |m|; the one of even number is the cosine.
    const int azimuthal = radial % 2 + 2 * ((left + (radial + 1) % 2) / 2);
    return {.radial = radial, .azimuthal = azimuthal, .sine = azimuthal > 0 && number % 2 != 0};
}

double zernike(int number, glm::dvec2 at) {
    const auto [radial, azimuthal, sine] = zernike_order(number);
    const double rho = glm::length(at);
    // The terms of the radial polynomial alternate in sign and grow with the order; up to order 20 cancellation leaves
    // an error of 1e-9.
    double sum = 0;
    for (int k = 0; k <= (radial - azimuthal) / 2; ++k) {
        const double size =
            std::exp(std::lgamma(radial - k + 1) - std::lgamma(k + 1) - std::lgamma((radial + azimuthal) / 2 - k + 1) -
                     std::lgamma((radial - azimuthal) / 2 - k + 1));
        sum += (k % 2 == 0 ? size : -size) * std::pow(rho, radial - 2 * k);
    }
    const double scale = std::sqrt((azimuthal == 0 ? 1.0 : 2.0) * (radial + 1));
    const double angle = azimuthal * std::atan2(at.y, at.x);
    return scale * sum * (sine ? std::sin(angle) : std::cos(angle));
}

const char* zernike_name(int number) {
    constexpr std::array names = {"",
                                  "piston",
                                  "tilt x",
                                  "tilt y",
                                  "defocus",
                                  "astigmatism at 45 degrees",
                                  "astigmatism at 0 degrees",
                                  "coma y",
                                  "coma x",
                                  "trefoil y",
                                  "trefoil x",
                                  "spherical aberration"};
    constexpr int secondary_spherical = 22;
    return number == secondary_spherical                 ? "secondary spherical aberration"
           : number < static_cast<int>(std::size(names)) ? names[static_cast<std::size_t>(number)]
                                                         : "";
}

std::vector<double> zernike_coefficients(const Wavefront& wavefront, int count) {
    constexpr int rings = 24;
    constexpr int spokes = 48;
    std::vector<double> coefficients(static_cast<std::size_t>(count), 0.0);
    for (const QuadratureNode& share : gauss_legendre(rings, 0, 1)) {
        for (int spoke = 0; spoke < spokes; ++spoke) {
            const double azimuth = 2 * pi * spoke / spokes;
            const glm::dvec2 at = std::sqrt(share.place) * glm::dvec2(std::cos(azimuth), std::sin(azimuth));
            const double waves =
                wavefront.path(wavefront.chief() + wavefront.smallest_rim() * at) / wavefront.wavelength();
            for (std::size_t j = 0; j < coefficients.size(); ++j) {
                coefficients[j] += share.weight / spokes * waves * zernike(static_cast<int>(j) + 1, at);
            }
        }
    }
    return coefficients;
}

} // namespace vkfv::optics
