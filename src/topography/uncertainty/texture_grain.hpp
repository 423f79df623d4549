// How far the texture's grains reach.
#pragma once

#include "core/mathematics/grid.hpp"
#include "topography/focus_measure.hpp"

namespace vkfv::topography {

// Correlation of the texture's strength, as the measure weighs it, of pixels (dx, dy) apart, in the image that is in
// focus everywhere: at (dx + reach, dy + reach), with the reach of the window's width less one, 16 at most. Strength is
// over its mean in three windows' width, so that a print that is stronger in one place than in another is no grain. 1
// in the middle; 0 all around it where there is no texture. Large images tell it by their middle.
Grid<double> grain_correlation(const Channels& all_in_focus, FocusMeasure measure, const FocusWindow& window);

} // namespace vkfv::topography
