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

// The profile as a map of one row, for what is defined over areas.
HeightMap map_of(const Profile& profile);

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

// ISO 21920-2:2021, of a roughness profile; NaN without a measured point. Heights, in mm, are taken from their mean.
// Means over the sections are NaN where a section has no point: the 2021 edition names the default of five section
// lengths where ISO 4287:1997 named sampling lengths.
struct ProfileParameters {
    double ra = undefined;  // arithmetic mean height
    double rq = undefined;  // root mean square height
    double rz = undefined;  // mean over the sections of the highest peak's height plus the deepest pit's depth
    double rp = undefined;  // mean over the sections of the highest peak's height
    double rv = undefined;  // mean over the sections of the deepest pit's depth, positive
    double rt = undefined;  // from the deepest pit to the highest peak of the whole profile
    double rsk = undefined; // skewness, 1
    double rku = undefined; // kurtosis, 1
    double rdq = undefined; // root mean square slope, of the differences of neighbours, 1
    double rsm = undefined; // mean spacing of the profile elements, mm (profile_elements.hpp)
    double rc = undefined;  // mean height of the profile elements
    double rdc = undefined; // material ratio height difference, from 2 % to 98 %
    double rk = undefined;  // core height, reduced peak height and reduced pit depth, and the shares of the length
    double rpk = undefined; // above the core and above the pits, 0 to 1 (material_ratio.hpp)
    double rvk = undefined;
    double rmrk1 = undefined;
    double rmrk2 = undefined;
};

// `sections`: into how many equal section lengths the profile falls (std::invalid_argument unless positive).
ProfileParameters profile_parameters(const Profile& profile, int sections = 5);

} // namespace vkfv::surface
