#include "report/colours.hpp"

#include "core/mathematics/units.hpp"

#include <algorithm>
#include <cmath>

namespace vkfv::report {
namespace {

std::uint8_t byte_of(double share) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
}

Rgb cubehelix(double value) {
    const double angle = 2 * pi * (0.5 / 3 + 1 - value);
    const double amplitude = 0.5 * value * (1 - value);
    const double c = std::cos(angle), s = std::sin(angle);
    return {byte_of(value + amplitude * (-0.14861 * c + 1.78277 * s)),
            byte_of(value + amplitude * (-0.29227 * c - 0.90649 * s)), byte_of(value + amplitude * 1.97294 * c)};
}

Rgb diverging(double value) {
    // The scale goes from white to a blue and a red of about the same brightness.
    const double d = 2 * value - 1, t = std::abs(d);
    const double full[2][3] = {{0.13, 0.30, 0.65}, {0.70, 0.16, 0.12}};
    const double* const end = full[d > 0];
    return {byte_of(1 + (end[0] - 1) * t), byte_of(1 + (end[1] - 1) * t), byte_of(1 + (end[2] - 1) * t)};
}

} // namespace

Rgb colour_of(Palette palette, double value) {
    const double inside = std::clamp(value, 0.0, 1.0);
    switch (palette) {
    case Palette::grey:
        return {byte_of(inside), byte_of(inside), byte_of(inside)};
    case Palette::height:
        return cubehelix(inside);
    case Palette::signed_deviation:
        return diverging(inside);
    }
    return {};
}

} // namespace vkfv::report
