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

// The profile as a map of one row, for functions defined over areas.
HeightMap map_of(const Profile& profile);

// The profile from (x_start, y_start) towards (x_end, y_end), in mm of the map's frame, with as many points as fit,
// `spacing` mm apart (std::invalid_argument unless positive). Heights are bilinear between the four points around; NaN
// beyond the map, and if a point with a weight is not measured.
Profile extract_profile(const HeightMap& map, double x_start, double y_start, double x_end, double y_end,
                        double spacing);

// The linear profile Gaussian filter of ISO 16610-21, with the treatment of ends and gaps of the areal
// gaussian_low_pass() (filter.hpp). `nesting_index` is the cut-off wavelength, mm.
Profile gaussian_low_pass(const Profile& profile, double nesting_index);
// The roughness profile of ISO 21920-2: the profile minus its Gaussian low-pass.
Profile remove_long_waves(const Profile& profile, double nesting_index);

// Parameters of a roughness profile (ISO 21920-2:2021); NaN without a measured point. Heights, in mm, are relative to
// their mean. Means over the sections are NaN if a section has no point: the 2021 edition has five section lengths by
// default where ISO 4287:1997 had sampling lengths.
struct ProfileParameters {
    double ra = undefined;    // arithmetic mean height
    double rq = undefined;    // root mean square height
    double rz = undefined;    // highest peak's height plus deepest pit's depth, mean over the sections
    double rp = undefined;    // highest peak's height, mean over the sections
    double rv = undefined;    // deepest pit's depth, positive, mean over the sections
    double rt = undefined;    // from the deepest pit to the highest peak of the whole profile
    double rsk = undefined;   // skewness, 1
    double rku = undefined;   // kurtosis, 1
    double rdq = undefined;   // root mean square slope between neighbours, 1
    double rsm = undefined;   // mean spacing of the profile elements, mm (profile_elements.hpp)
    double rc = undefined;    // mean height of the profile elements
    double rdc = undefined;   // material ratio height difference, from 2 % to 98 %
    double rk = undefined;    // core height (material_ratio.hpp)
    double rpk = undefined;   // reduced peak height
    double rvk = undefined;   // reduced pit depth
    double rmrk1 = undefined; // share of the length above the core, 0 to 1
    double rmrk2 = undefined; // share of the length above the pits, 0 to 1
};

// The parameters of a profile. `sections`: the number of equal section lengths into which the profile is divided
// (std::invalid_argument unless positive).
ProfileParameters profile_parameters(const Profile& profile, int sections = 5);

} // namespace vkfv::surface
