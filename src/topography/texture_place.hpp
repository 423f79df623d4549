// A focus window finds the height where its texture is, not at its middle: on a slope, a window whose strongest texture
// lies uphill is measured too high. The image in focus shows where the texture is, and the heights around show the
// slope.
#pragma once

#include "core/mathematics/grid.hpp"
#include "topography/focus_measure.hpp"

namespace vkfv::topography {

// Carries each height from the centre of its window's texture to the window's middle, along the plane that fits the
// heights within twice the window's reach. The texture is weighted as the measure weights it, in the image that is in
// focus everywhere. A slope counts by the share of its square that chance does not explain: the distances of the
// heights from the plane are taken as independent from one window to the next. Where fewer than half of the heights
// around are finite, and where there is no texture, a height is unchanged; NaN stays NaN. Heights in any unit. Both
// grids are of one size: std::invalid_argument otherwise.
void place_by_texture(Grid<double>& height, const Channels& all_in_focus, FocusMeasure measure,
                      const FocusWindow& window);

} // namespace vkfv::topography
