// Scale-limited surfaces (ISO 25178-2): form removed, short and long waves filtered out.
#pragma once

#include "surface/form.hpp"
#include "surface/spline_filter.hpp"

#include <array>
#include <string_view>

namespace vkfv::surface {

// The limits of scale of a surface. Nesting indices of the S-filter and L-filter in mm; 0: no filter.
struct Band {
    double s_filter = 0; // S-filter, removes shorter waves
    double l_filter = 0; // L-filter, removes longer waves
    bool spline = false; // spline_filter.hpp instead of the Gaussian of ISO 16610-61
    bool robust = false; // robust_filter.hpp; excludes `spline`
    SplineEnds spline_ends = SplineEnds::natural;
    Form form = {}; // removed before both filters

    bool limited() const { return s_filter > 0 || l_filter > 0; } // true if any filter is set
    bool operator==(const Band&) const = default;
};

// Applies the filters alone: S, then L with the removal of rounding (form.hpp).
HeightMap filtered(HeightMap map, const Band& band);

// The filters' names in configuration and command line.
inline constexpr std::array filter_names = {"gaussian", "spline", "spline-mirrored", "robust-gaussian"};
const char* filter_name(const Band& band);
// Sets the filter of this name; throws std::invalid_argument for an unknown one.
void take_filter(Band& band, std::string_view name);

// Removes the form and applies the filters.
HeightMap scale_limited(HeightMap map, const Band& band);

} // namespace vkfv::surface
