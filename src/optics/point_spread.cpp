#include "optics/quadrature.hpp"
#include "optics/wave_image.hpp"

#include "core/units.hpp"

#include <algorithm>
#include <cmath>

namespace vkfv::optics {

namespace {

// A pupil's area in pieces.
struct Piece {
    glm::dvec2 p = glm::dvec2(0);
    double area = 0;
};

std::vector<Piece> pieces_of(const Wavefront& wavefront, int rings, int spokes) {
    std::vector<Piece> pieces;
    for (int spoke = 0; spoke < spokes; ++spoke) {
        const double azimuth = 2 * pi * spoke / spokes;
        const double rim = wavefront.rim(azimuth);
        for (const QuadratureNode& radius : gauss_legendre(rings, 0, 1)) {
            pieces.push_back({.p = wavefront.chief() + radius.place * rim * direction_of(azimuth),
                              .area = radius.weight * radius.place * rim * rim * 2 * pi / spokes});
        }
    }
    return pieces;
}

// The shift a with the least variance of W - p . (a - aside) over pupil and spectrum, in wavelengths.
glm::dvec2 centre_of(const WaveImage& image) {
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

PointSpread WaveImage::point_spread(double reach) const {
    const glm::dvec2 centre = centre_of(*this);
    std::vector<PointSpread::Pupil> pupils;
    for (const Wavefront& wavefront : wavefronts_) {
        const double wave_number = 2 * pi / wavefront.wavelength();
        // A phase of x rad along a radius takes x / 2 nodes and some more, round the pupil 2 x.
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

double PointSpread::value(glm::dvec2 from_centre) const {
    double light = 0;
    for (const Pupil& pupil : pupils_) {
        const glm::dvec2 turn = -pupil.wave_number * from_centre;
        double real = 0;
        double imaginary = 0;
        for (const Sample& sample : pupil.samples) {
            const double phase = glm::dot(sample.p, turn);
            const double cosine = std::cos(phase);
            const double sine = std::sin(phase);
            real += sample.amplitude.real() * cosine - sample.amplitude.imag() * sine;
            imaginary += sample.amplitude.real() * sine + sample.amplitude.imag() * cosine;
        }
        light += pupil.scale * (real * real + imaginary * imaginary);
    }
    return light;
}

double PointSpread::ideal_peak() const {
    double ideal = 0;
    for (const Pupil& pupil : pupils_) {
        ideal += pupil.ideal_peak;
    }
    return ideal;
}

double PointSpread::strehl() const {
    return ideal_peak() > 0 ? value(glm::dvec2(0)) / ideal_peak() : NAN;
}

double PointSpread::around(double radius) const {
    constexpr int azimuths = 16; // what a wavefront's coma and astigmatism make
    double sum = 0;
    for (int i = 0; i < azimuths; ++i) {
        sum += value(radius * direction_of(2 * pi * (i + 0.5) / azimuths)) / azimuths;
    }
    return sum;
}

std::vector<double> PointSpread::dark_rings(int count) const {
    // A step is a 24th of the rings' distance; between neighbours of the least value a golden section.
    const double step = ring_distance() / 24;
    std::vector<double> rings;
    double before = around(0);
    double here = around(step);
    for (int i = 1; i * step < reach_ && static_cast<int>(rings.size()) < count; ++i) {
        const double next = around((i + 1) * step);
        if (here < before && here <= next) {
            double low = (i - 1) * step;
            double high = (i + 1) * step;
            constexpr double golden = 0.6180339887498949;
            for (int k = 0; k < 24; ++k) {
                const double left = high - golden * (high - low);
                const double right = low + golden * (high - low);
                (around(left) < around(right) ? high : low) = around(left) < around(right) ? right : left;
            }
            rings.push_back(0.5 * (low + high));
        }
        before = here;
        here = next;
    }
    return rings;
}

double PointSpread::ring_distance() const {
    double rim = 0;
    double wave_number = 0;
    for (const Pupil& pupil : pupils_) {
        wave_number = std::max(wave_number, pupil.wave_number);
        for (const Sample& sample : pupil.samples) {
            rim = std::max(rim, glm::length(sample.p));
        }
    }
    return rim > 0 ? pi / (wave_number * rim) : reach_;
}

std::vector<double> PointSpread::encircled(std::span<const double> radii) const {
    constexpr int fewest = 8; // nodes of each part, and as many per ring
    std::vector<double> light;
    double sum = 0;
    double before = 0;
    for (const double radius : radii) {
        const int count = fewest * (1 + static_cast<int>((radius - before) / ring_distance()));
        for (const QuadratureNode& node : gauss_legendre(count, before, radius)) {
            sum += node.weight * 2 * pi * node.place * around(node.place);
        }
        light.push_back(sum);
        before = radius;
    }
    return light;
}

} // namespace vkfv::optics
