#include "optics/waves/point_waves.hpp"

#include "core/mathematics/units.hpp"
#include "optics/waves/quadrature.hpp"
#include "optics/waves/transfer.hpp"

#include <algorithm>
#include <cmath>

namespace vkfv::optics {

namespace {

// A piece of a pupil's area.
struct Piece {
    glm::dvec2 p = glm::dvec2(0);
    double area = 0;
};

std::vector<Piece> pieces_of(const Wavefront& wavefront, int rings, int spokes) {
    std::vector<Piece> pieces;
    const auto nodes = gauss_legendre(rings, 0, 1);
    for (int spoke = 0; spoke < spokes; ++spoke) {
        const double azimuth = 2 * pi * spoke / spokes;
        const double rim = wavefront.rim(azimuth);
        for (const QuadratureNode& radius : nodes) {
            pieces.push_back({.p = wavefront.chief() + radius.place * rim * direction_of(azimuth),
                              .area = radius.weight * radius.place * rim * rim * 2 * pi / spokes});
        }
    }
    return pieces;
}

// The shift a with the least variance of W - p . (a - aside), in wavelengths, over pupil and spectrum.
glm::dvec2 centre_of(const PointWaves& image) {
    glm::dmat2 normal(0);
    glm::dvec2 right(0);
    for (const Wavefront& wavefront : image.wavefronts()) {
        constexpr int rings = 16;
        constexpr int spokes = 48;
        const auto pieces = pieces_of(wavefront, rings, spokes);
        double area = 0;
        double mean_path = 0;
        glm::dvec2 mean_p(0);
        for (const Piece& piece : pieces) {
            area += piece.area;
            mean_path += piece.area * wavefront.path(piece.p);
            mean_p += piece.area * piece.p;
        }
        for (const Piece& piece : pieces) {
            const double weight =
                wavefront.weight() * piece.area / area / (wavefront.wavelength() * wavefront.wavelength());
            const glm::dvec2 p = piece.p - mean_p / area;
            const double path = wavefront.path(piece.p) - mean_path / area + glm::dot(p, image.aside(wavefront));
            normal += weight * glm::outerProduct(p, p);
            right += weight * path * p;
        }
    }
    return glm::determinant(normal) > 0 ? glm::inverse(normal) * right : glm::dvec2(0);
}

} // namespace

PointWaves::PointWaves(const Instrument& instrument, glm::dvec2 field, int most)
    : wavefronts_(wavefronts_of(instrument, at_most(most, spectral_nodes(instrument, most)), field)) {}

PointWaves PointWaves::at_height(double height) const {
    PointWaves other = *this;
    for (Wavefront& wavefront : other.wavefronts_) {
        wavefront = wavefront.at_height(height);
    }
    return other;
}

const Wavefront& PointWaves::middle() const {
    double before = 0;
    for (const Wavefront& wavefront : wavefronts_) {
        before += wavefront.weight();
        if (before >= 0.5) {
            return wavefront;
        }
    }
    return wavefronts_.back();
}

glm::dvec2 PointWaves::aside(const Wavefront& wavefront) const {
    return middle().object_point() - wavefront.object_point();
}

double PointWaves::cutoff() const {
    double most = 0;
    for (const Wavefront& wavefront : wavefronts_) {
        most = std::max(most, 2 * wavefront.largest_rim() / wavefront.wavelength());
    }
    return most;
}

std::complex<double> PointWaves::transfer(glm::dvec2 frequency) const {
    std::complex<double> sum = 0;
    for (const Wavefront& wavefront : wavefronts_) {
        sum += wavefront.weight() * optics::transfer(wavefront, frequency) *
               std::polar(1.0, -2 * pi * glm::dot(frequency, aside(wavefront)));
    }
    return sum;
}

PointSpread PointWaves::point_spread(double reach) const {
    const glm::dvec2 centre = centre_of(*this);
    std::vector<PointSpread::Pupil> pupils;
    for (const Wavefront& wavefront : wavefronts_) {
        const double wave_number = 2 * pi / wavefront.wavelength();
        // A phase of x rad along a radius needs x / 2 nodes plus a few, a turn about the pupil 2 x; the factors leave a
        // margin.
        const glm::dvec2 from = centre - aside(wavefront);
        const double phase = wave_number * ((reach + glm::length(from)) * wavefront.largest_rim() + wavefront.range());
        const int rings = 16 + static_cast<int>(0.6 * phase);
        const int spokes = 48 + static_cast<int>(2.2 * phase);
        PointSpread::Pupil pupil{.wave_number = wave_number, .scale = 0, .ideal_peak = 0, .samples = {}};
        double area = 0;
        for (const Piece& piece : pieces_of(wavefront, rings, spokes)) {
            const glm::dvec2 p = piece.p - wavefront.chief();
            area += piece.area;
            pupil.samples.push_back(
                {.p = p,
                 .amplitude = std::polar(piece.area, wave_number * (wavefront.path(piece.p) - glm::dot(p, from)))});
        }
        const double square = wavefront.wavelength() * wavefront.wavelength();
        pupil.scale = area > 0 ? wavefront.weight() / (square * area) : 0;
        pupil.ideal_peak = wavefront.weight() * area / square;
        pupils.push_back(std::move(pupil));
    }
    return {std::move(pupils), centre, reach};
}

} // namespace vkfv::optics
