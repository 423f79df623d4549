// Curves over an axis, and values over an area: the panels that the report's pictures are made of.
#pragma once

#include "core/mathematics/grid.hpp"
#include "report/colours.hpp"
#include "report/svg.hpp"

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace vkfv::report {

// The range and label of an axis. Equal ends are widened.
struct Axis {
    double from = 0;
    double to = 0;
    std::string label;    // quantity and unit: "x / um"
    bool decades = false; // logarithmic; ends positive
};

struct Curve {
    std::string name;               // empty: not in the legend
    std::vector<glm::dvec2> points; // a NaN breaks the line
    std::vector<double> spreads;    // relative length of an error bar in y at each point; empty: none
    bool line = true;
    bool markers = false;
};

// The axis over all finite values of the curves' points in that direction (0: x, 1: y), with a little room in y;
// decades end at powers of ten.
Axis axis_over(std::span<const Curve> curves, int direction, std::string label, bool decades = false);

// A chart within the rectangle (labels included); curves take line_colours in their order.
void draw_chart(Svg& svg, glm::dvec2 corner, glm::dvec2 size, std::string_view title, const Axis& x, const Axis& y,
                std::span<const Curve> curves);

// Where a value of x and y lies in such a chart, for marks over it.
glm::dvec2 place_in_chart(glm::dvec2 corner, glm::dvec2 size, const Axis& x, const Axis& y, glm::dvec2 value);

// A chart of a picture that has several.
struct Chart {
    std::string title, x_label, y_label;
    std::vector<Curve> curves;
    bool x_decades = false;
};

// Draws bars that touch, over x; `counts` are of equal intervals between from and to.
void draw_histogram(Svg& svg, glm::dvec2 corner, glm::dvec2 size, std::string_view title, const Axis& x,
                    std::span<const double> counts);

// Values over an area, in micrometres unless the labels say otherwise; NaN is shown as not measured.
struct Map {
    std::string title;
    std::string unit = "um"; // unit of the values, shown beside the colour bar
    Grid<double> values;
    double x0 = 0, y0 = 0;    // um, middle of value (0, 0)
    glm::dvec2 pitch{1, 1};   // um
    double low = 0, high = 1; // values at the palette's ends
    Palette palette = Palette::height;
    std::optional<Grid<double>> brightness{}; // in [0, 1], dims the colours; none: 1 throughout
    bool colour_bar = true;
    std::string x_label = "x / um", y_label = "y / um";
    bool of_place = true;  // true: x and y are lengths of a place; false: each fills its side
    bool scale_bar = true; // for a place
    Rgb not_a_number = not_measured_colour;
};

// Draws the map with axes, a scale bar and a colour bar. Scales in x and y are equal for a place; values are averaged
// where there are more than two of them to a pixel of the picture, along either side.
void draw_map(Svg& svg, glm::dvec2 corner, glm::dvec2 size, const Map& map);

// The range that holds all finite values except a share `outside`, half of it at either end; {0, 1} if there are none.
std::pair<double, double> range_of(const Grid<double>& values, double outside);

// Values from `from` to `to` at distances of 1, 2 or 5 times a power of ten, about `count` of them.
std::vector<double> ticks(double from, double to, int count);

// A number with a prefix: 1.5 k, 20 M.
std::string with_prefix(double value);

} // namespace vkfv::report
