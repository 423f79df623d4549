// The focal positions of a stack.
#pragma once

#include <vector>

namespace vkfv::scan {

// Heights of the focal plane in the specimen frame, mm. Ascending: the axial scan starts at the lowest
// position.
struct ScanPlan {
    double z_start = 0;
    double z_stop = 0;
    double z_step = 0;

    // z_start + i * z_step for i = 0, 1, ... up to z_stop, which counts as reached within a millionth of a step:
    // decimal steps do not lose their last image to rounding. Throws InputError for a step that is not positive, a stop
    // below the start, a value that is not finite, and more positions than an image series can number (most_positions).
    std::vector<double> positions() const;

    // The number of positions, unchecked; it may be any size if z_step is small.
    double position_count() const;
};

// Image files are numbered with four digits, z_0000 to z_9999.
inline constexpr int most_positions = 10000;

} // namespace vkfv::scan
