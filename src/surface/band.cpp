#include "surface/band.hpp"

#include "surface/filter.hpp"
#include "surface/robust_filter.hpp"
#include "surface/spline_filter.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace vkfv::surface {

HeightMap filtered(HeightMap map, const Band& band) {
    const auto low_pass = [&](double nesting_index) {
        if (band.robust)
            return robust_gaussian_low_pass(map, nesting_index);
        return band.spline ? spline_low_pass(map, nesting_index, band.spline_ends)
                           : gaussian_low_pass(map, nesting_index);
    };
    if (band.s_filter > 0)
        map = low_pass(band.s_filter);
    if (band.l_filter > 0) {
        const double greatest = greatest_height(map);
        const HeightMap long_waves = low_pass(band.l_filter);
        for (std::size_t k = 0; k < map.height.values.size(); ++k)
            map.height.values[k] -= long_waves.height.values[k];
        map = without_rounding(std::move(map), greatest);
    }
    return map;
}

const char* filter_name(const Band& band) {
    if (band.robust)
        return filter_names[3];
    return filter_names[band.spline ? (band.spline_ends == SplineEnds::natural ? 1 : 2) : 0];
}

void take_filter(Band& band, std::string_view name) {
    if (std::ranges::find(filter_names, name) == filter_names.end())
        throw std::invalid_argument("take_filter: no filter of this name");
    band.robust = name == filter_names[3];
    band.spline = !band.robust && name != filter_names[0];
    band.spline_ends = name == filter_names[2] ? SplineEnds::mirrored : SplineEnds::natural;
}

HeightMap scale_limited(HeightMap map, const Band& band) {
    return filtered(remove_form(std::move(map), band.form), band);
}

} // namespace vkfv::surface
