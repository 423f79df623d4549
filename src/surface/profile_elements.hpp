// Profile elements of ISO 21920-2: a hill and the dale beside it.
#pragma once

#include "surface/profile.hpp"

namespace vkfv::surface {

// mm; NaN where the profile has no whole element.
struct ProfileElements {
    double mean_spacing = undefined; // from one upward crossing of the reference line to the next
    double mean_height = undefined;  // from an element's lowest to its highest point
    int count = 0;
};

// A hill counts if it rises above the reference line by `threshold` (mm; ISO 21920-2 takes a tenth of Rz), a dale if it
// falls as far below it; a lesser one belongs to what surrounds it. Crossings are linear between points. A gap ends an
// element, and none reaches over it.
ProfileElements profile_elements(const Profile& profile, double reference, double threshold);

} // namespace vkfv::surface
