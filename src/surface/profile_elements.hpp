// Profile elements of ISO 21920-2: a hill and the adjacent dale.
#pragma once

#include "surface/profile.hpp"

namespace vkfv::surface {

// Means over the profile elements, in mm; NaN if the profile has no whole element.
struct ProfileElements {
    double mean_spacing = undefined; // from one upward crossing of the reference line to the next
    double mean_height = undefined;  // from an element's lowest to its highest point
    int count = 0;
};

// Finds the profile elements. A hill counts if it rises above the reference line by `threshold` (mm; ISO 21920-2 uses a
// tenth of Rz), a dale if it falls as far below it; smaller ones belong to their surroundings. Crossings are linear
// between points. Elements end at a gap, and none spans one.
ProfileElements profile_elements(const Profile& profile, double reference, double threshold);

} // namespace vkfv::surface
