// The size of the texture's grains.
#pragma once

#include "core/mathematics/grid.hpp"
#include "topography/focus_measure.hpp"

namespace vkfv::topography {

// The correlation of the texture's strength, as the measure weights it, for pixels (dx, dy) apart, in the image that is
// in focus everywhere: at (dx + reach, dy + reach), with the reach of the window's width less one, 16 at most. Strength
// is divided by its mean over three windows' width, so that slow changes of texture are no grain. The value is 1 in the
// middle, and 0 all around it where there is no texture. Of large images only the middle is used.
Grid<double> grain_correlation(const Channels& all_in_focus, FocusMeasure measure, const FocusWindow& window);

} // namespace vkfv::topography
