#include "optics/waves/point_spread.hpp"

#include "core/mathematics/units.hpp"
#include "optics/waves/quadrature.hpp"

#include <algorithm>
#include <cmath>

namespace vkfv::optics {

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
    constexpr int azimuths = 16; // enough for a wavefront's coma and astigmatism
    double sum = 0;
    for (int i = 0; i < azimuths; ++i) {
        sum += value(radius * direction_of(2 * pi * (i + 0.5) / azimuths)) / azimuths;
    }
    return sum;
}

std::vector<double> PointSpread::dark_rings(int count) const {
    // The search steps by a 24th of the rings' distance; between the neighbours of a minimum follows a golden-section
    // search.
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
    constexpr int fewest = 8; // nodes in each interval, plus as many per ring
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
