// Numbers with bounds: affine arithmetic (J. Stolfi and L. H. de Figueiredo, "Self-validated numerical methods and
// applications", 1997). An affine form bounds a function of a few coordinates by a linear part and a remainder, so that
// dependences that two numbers share cancel where plain intervals would add: bounds of a whole train stay narrow, and
// the remainders fall with the square of the box. Rounding is not directed outward: see bundle.cpp.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace vkfv::optics {

struct Range {
    double low = 0;
    double high = 0;

    double middle() const { return 0.5 * (low + high); }
    double radius() const { return 0.5 * (high - low); }
    double magnitude() const { return std::max(std::abs(low), std::abs(high)); }
};

// centre + sum of slopes[i] e_i + rest e, where |e_i| <= 1 are the coordinates of a box and |e| <= 1 is unknown. The
// function takes one of these values wherever it is defined.
struct Affine {
    static constexpr std::size_t coordinates = 5;

    double centre = 0;
    std::array<double, coordinates> slopes{};
    double rest = 0; // >= 0

    double radius() const {
        double sum = rest;
        for (const double slope : slopes) {
            sum += std::abs(slope);
        }
        return sum;
    }
    double low() const { return centre - radius(); }
    double high() const { return centre + radius(); }
    Range range() const { return {low(), high()}; }
};

inline Affine constant(double value) {
    return {.centre = value};
}

// The form of a number of which only its range is known.
inline Affine anything_in(const Range& range) {
    return {.centre = range.middle(), .rest = range.radius()};
}

inline Affine coordinate(std::size_t which, const Range& range) {
    Affine result = constant(range.middle());
    result.slopes[which] = range.radius();
    return result;
}

inline Affine operator*(double factor, const Affine& a) {
    Affine result{.centre = factor * a.centre, .rest = std::abs(factor) * a.rest};
    for (std::size_t i = 0; i < Affine::coordinates; ++i) {
        result.slopes[i] = factor * a.slopes[i];
    }
    return result;
}

inline Affine operator+(const Affine& a, const Affine& b) {
    Affine result{.centre = a.centre + b.centre, .rest = a.rest + b.rest};
    for (std::size_t i = 0; i < Affine::coordinates; ++i) {
        result.slopes[i] = a.slopes[i] + b.slopes[i];
    }
    return result;
}

inline Affine operator-(const Affine& a, const Affine& b) {
    return a + -1.0 * b;
}

// The product uses that e_i^2 lies between 0 and 1 and e_i e_j between -1 and 1.
inline Affine operator*(const Affine& a, const Affine& b) {
    const double linear_a = a.radius() - a.rest;
    const double linear_b = b.radius() - b.rest;
    Affine result{.centre = a.centre * b.centre,
                  .rest = (std::abs(a.centre) + linear_a) * b.rest + (std::abs(b.centre) + linear_b) * a.rest +
                          a.rest * b.rest};
    for (std::size_t i = 0; i < Affine::coordinates; ++i) {
        result.slopes[i] = a.centre * b.slopes[i] + b.centre * a.slopes[i];
        const double half = 0.5 * a.slopes[i] * b.slopes[i];
        result.centre += half;
        result.rest += std::abs(half);
        for (std::size_t j = 0; j < i; ++j) {
            result.rest += std::abs(a.slopes[i] * b.slopes[j] + a.slopes[j] * b.slopes[i]);
        }
    }
    return result;
}

// The square is narrower than a * a, because the remainder's square has one sign.
inline Affine square(const Affine& a) {
    const double radius = a.radius();
    const double half = 0.5 * radius * radius;
    Affine result{.centre = a.centre * a.centre + half, .rest = 2 * std::abs(a.centre) * a.rest + half};
    for (std::size_t i = 0; i < Affine::coordinates; ++i) {
        result.slopes[i] = 2 * a.centre * a.slopes[i];
    }
    return result;
}

// The linear function slope * a + offset, with a remainder of at most `error`.
inline Affine line(const Affine& a, double slope, double offset, double error) {
    Affine result = slope * a + constant(offset);
    result.rest += error;
    return result;
}

// The square root of the values of a that are >= 0; requires a.high() > 0. The chord between the ends lies below the
// root, farthest from it where their slopes are equal.
inline Affine square_root(const Affine& a) {
    const double low = std::sqrt(std::max(a.low(), 0.0));
    const double slope = 1 / (low + std::sqrt(a.high()));
    const double least = low - slope * low * low;
    const double most = 0.25 / slope;
    return line(a, slope, 0.5 * (least + most), 0.5 * (most - least));
}

// 1 / a; requires a.low() > 0.
inline Affine reciprocal(const Affine& a) {
    const double low = a.low();
    const double high = a.high();
    const double most = 1 / low + 1 / high;
    const double least = 2 / std::sqrt(low * high);
    return line(a, -1 / (low * high), 0.5 * (least + most), 0.5 * (most - least));
}

// A sine or cosine by the tangent at the centre: its second derivative is at most 1. Wide forms are bounded by [-1, 1].
inline Affine by_tangent(const Affine& a, double value, double slope) {
    const double radius = a.radius();
    return radius < 1 ? line(a, slope, value - slope * a.centre, 0.5 * radius * radius) : anything_in({-1, 1});
}
inline Affine cosine(const Affine& a) {
    return by_tangent(a, std::cos(a.centre), -std::sin(a.centre));
}
inline Affine sine(const Affine& a) {
    return by_tangent(a, std::sin(a.centre), std::cos(a.centre));
}

} // namespace vkfv::optics
