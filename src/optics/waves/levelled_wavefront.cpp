#include "optics/waves/levelled_wavefront.hpp"

#include "core/mathematics/units.hpp"
#include "optics/waves/quadrature.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace vkfv::optics {

LevelledWavefront levelled(const Wavefront& wavefront) {
    constexpr int rings = 24;
    constexpr int spokes = 96;
    struct Share {
        glm::dvec2 p;
        double path;
        double weight;
    };
    std::vector<Share> shares;
    double area = 0;
    double mean_path = 0;
    glm::dvec2 middle(0);
    const auto nodes = gauss_legendre(rings, 0, 1); // in the squared relative radius
    for (int spoke = 0; spoke < spokes; ++spoke) {
        const double azimuth = 2 * pi * spoke / spokes;
        const double rim = wavefront.rim(azimuth);
        for (const QuadratureNode& node : nodes) {
            const glm::dvec2 p = rim * std::sqrt(node.place) * direction_of(azimuth);
            const double weight = node.weight * rim * rim;
            shares.push_back({p, wavefront.path(wavefront.chief() + p), weight});
            area += weight;
            mean_path += weight * shares.back().path;
            middle += weight * p;
        }
    }
    if (!(area > 0)) {
        return {};
    }
    mean_path /= area;
    middle /= area;
    glm::dmat2 normal(0);
    glm::dvec2 right(0);
    for (Share& share : shares) {
        share.p -= middle;
        share.path -= mean_path;
        normal += share.weight * glm::outerProduct(share.p, share.p);
        right += share.weight * share.path * share.p;
    }
    LevelledWavefront result;
    result.tilt = glm::determinant(normal) > 0 ? glm::inverse(normal) * right : glm::dvec2(0);
    result.piston = mean_path - glm::dot(result.tilt, middle);
    double square = 0;
    for (const Share& share : shares) {
        const double rest = share.path - glm::dot(result.tilt, share.p);
        square += share.weight * rest * rest;
    }
    result.rms = std::sqrt(square / area);
    return result;
}

WavefrontQuality wavefront_quality(const PointWaves& waves) {
    const Wavefront& middle = waves.middle();
    if (!(middle.largest_rim() > 0)) {
        constexpr double none = std::numeric_limits<double>::quiet_NaN();
        return {.rms = none, .strehl = none};
    }
    return {.rms = levelled(middle).rms / middle.wavelength(), .strehl = waves.point_spread(0).strehl()};
}

WavefrontQuality wavefront_quality(const Instrument& instrument, glm::dvec2 field) {
    return wavefront_quality(PointWaves(instrument, field, wavelengths_of_figures));
}

} // namespace vkfv::optics
