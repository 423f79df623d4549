// Profiles through a height map, their filter and their parameters.
#pragma once

#include "surface/height_map.hpp"

#include <vector>

namespace vkfv::surface {

// Heights in mm at equal distances along a line; NaN means "not measured".
struct Profile {
    std::vector<double> height;
    double spacing = 0; // mm
};

// From (x_start, y_start) towards (x_end, y_end), in mm of the map's frame, as many points as fit, `spacing` mm apart
// (std::invalid_argument unless positive). Bilinear between the four points around; NaN beyond the map, and where one
// of the points that count is not measured.
Profile extract_profile(const HeightMap& map, double x_start, double y_start, double x_end, double y_end,
                        double spacing);

// The linear profile Gaussian filter of ISO 16610-21: what gaussian_low_pass() (filter.hpp) is over an area, with
// its treatment of ends and gaps. `nesting_index` is the cut-off wavelength, mm.
Profile gaussian_low_pass(const Profile& profile, double nesting_index);
// The roughness profile of ISO 21920-2: what that low-pass does not keep.
Profile remove_long_waves(const Profile& profile, double nesting_index);

// ISO 21920-2:2021, of a roughness profile, in mm; NaN without a measured point. Heights are taken from their mean.
struct ProfileParameters {
    double ra = 0; // arithmetic mean height
    double rq = 0; // root mean square height
    // Mean over the sections of the highest peak's height plus the deepest pit's depth. The 2021 edition names the
    // default of five section lengths where ISO 4287:1997 named sampling lengths. NaN where a section has no point.
    double rz = 0;
};

// `sections`: into how many equal section lengths the profile falls (std::invalid_argument unless positive).
ProfileParameters profile_parameters(const Profile& profile, int sections = 5);

} // namespace vkfv::surface
