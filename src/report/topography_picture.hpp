// Pictures of a measurement, as SVG.
#pragma once

#include "report/chart.hpp"
#include "surface/height_map.hpp"

#include <optional>
#include <string>
#include <vector>

namespace vkfv::report {

// The contents of a picture of heights; all maps on one grid.
struct TopographyPicture {
    std::string title;
    surface::HeightMap measured;
    std::optional<surface::HeightMap> truth;
    std::optional<surface::HeightMap> deviation; // measured minus true
    std::optional<Grid<float>> all_in_focus;
    std::string image_unit = "W"; // unit of its values
    std::vector<Chart> charts;    // further charts
};

// Measured heights, truth and deviation over x and y (one height scale for the first two), the all-in-focus image
// alone and under the heights' colours, the profile along the middle row, and the charts.
std::string topography_picture(const TopographyPicture& picture);

// The quantity of an image's values.
struct PixelQuantity {
    const char* unit;
    const char* label; // for an axis
};
inline constexpr PixelQuantity light_of_pixels{"W", "radiant flux of a pixel / W"};
inline constexpr PixelQuantity grey_values_of_pixels{"DN", "grey value / DN"};

// An image (pitch in mm, the middle of pixel (0, 0) at x0, y0) beside the histogram of its pixels, with
// its contrast: standard deviation over mean.
std::string image_picture(const std::string& title, const Grid<double>& image, double x0, double y0, double pitch,
                          const PixelQuantity& quantity);

} // namespace vkfv::report
