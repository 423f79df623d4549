#include "surface/profile_elements.hpp"

#include <algorithm>
#include <cmath>

namespace vkfv::surface {
namespace {

enum class Side { unknown, dale, hill };

} // namespace

ProfileElements profile_elements(const Profile& profile, double reference, double threshold) {
    double spacings = 0, heights = 0, count = 0;
    Side side = Side::unknown;
    double started = undefined;  // start of the element, in points
    double crossing = undefined; // first upward crossing since the dale's depth was reached
    double highest = undefined, lowest = undefined;
    for (std::size_t k = 0; k < profile.height.size(); ++k) {
        const double z = profile.height[k] - reference;
        if (!std::isfinite(z)) {
            side = Side::unknown;
            started = crossing = undefined;
            continue;
        }
        const double before = k > 0 ? profile.height[k - 1] - reference : undefined;
        // Only the first upward crossing after a dale counts; later ones are ripple within the threshold.
        if (before < 0 && z >= 0 && side == Side::dale && std::isnan(crossing)) {
            crossing = static_cast<double>(k) - z / (z - before);
        }
        if (z <= -threshold && side != Side::dale) {
            side = Side::dale;
            crossing = undefined;
        } else if (z <= -threshold) {
            crossing = undefined; // the profile fell back into the dale
        }
        if (z >= threshold && side == Side::dale) {
            if (std::isfinite(started)) {
                spacings += (crossing - started) * profile.spacing;
                heights += highest - lowest;
                count += 1;
            }
            started = crossing;
            highest = lowest = z;
        }
        if (z >= threshold) {
            side = Side::hill;
        }
        highest = std::fmax(highest, z);
        lowest = std::fmin(lowest, z);
    }
    if (!(count > 0)) {
        return {};
    }
    return {.mean_spacing = spacings / count, .mean_height = heights / count, .count = static_cast<int>(count)};
}

} // namespace vkfv::surface
