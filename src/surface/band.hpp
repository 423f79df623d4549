// Surfaces limited in scale as ISO 25178-2 has it: form removed, short and long waves filtered out.
#pragma once

#include "surface/form.hpp"
#include "surface/spline_filter.hpp"

#include <array>
#include <string_view>

namespace vkfv::surface {

// What is left of a surface. Nesting indices of the S-filter and L-filter in mm; 0: none.
struct Band {
    double s_filter = 0; // shorter waves are removed
    double l_filter = 0; // longer waves are removed
    bool spline = false; // by spline_filter.hpp, not by the Gaussian of ISO 16610-61
    bool robust = false; // by robust_filter.hpp; not with `spline`
    SplineEnds spline_ends = SplineEnds::natural;
    Form form = {}; // removed before both

    bool limited() const { return s_filter > 0 || l_filter > 0; } // by a filter
    bool operator==(const Band&) const = default;
};

// The filters alone: S, then L, of which no rounding is left (form.hpp).
HeightMap filtered(HeightMap map, const Band& band);

// Which filters, by the name that configuration and command line have for them.
inline constexpr std::array filter_names = {"gaussian", "spline", "spline-mirrored", "robust-gaussian"};
const char* filter_name(const Band& band);
// Throws std::invalid_argument for another name.
void take_filter(Band& band, std::string_view name);

// Form and filters.
HeightMap scale_limited(HeightMap map, const Band& band);

} // namespace vkfv::surface
