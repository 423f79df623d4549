// Colours for values and for the lines of a chart.
#pragma once

#include <array>
#include <cstdint>

namespace vkfv::report {

struct Rgb {
    std::uint8_t red = 0, green = 0, blue = 0;
};

// Colour scales for a value in [0, 1]; values outside take the end's colour.
enum class Palette {
    grey,
    // Brightness grows with the value, also in a grey print (D. A. Green, "A colour scheme for the display of
    // astronomical intensity images", 2011; start 0.5, -1 rotations, hue 1, gamma 1).
    height,
    signed_deviation, // blue below, white at 0.5, red above
};

Rgb colour_of(Palette palette, double value);

// The colour of points that were not measured, which no palette has.
inline constexpr Rgb not_measured_colour{255, 214, 0};

// Colours of a chart's lines, in this order (M. Okabe, K. Ito, "Color universal design", 2008).
inline constexpr std::array<const char*, 6> line_colours = {"#0072b2", "#d55e00", "#009e73",
                                                            "#cc79a7", "#e69f00", "#56b4e9"};

} // namespace vkfv::report
