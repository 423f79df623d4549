#include "topography/compare.hpp"

#include "surface/filter.hpp"
#include "surface/height_parameters.hpp"
#include "surface/spline_filter.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace vkfv::topography {
namespace {

using surface::HeightMap;

HeightMap less(HeightMap a, const HeightMap& b) {
    for (std::size_t k = 0; k < a.height.values.size(); ++k)
        a.height.values[k] -= b.height.values[k];
    return a;
}

HeightMap low_pass(const HeightMap& map, double nesting_index, bool spline) {
    return spline ? surface::spline_low_pass(map, nesting_index) : surface::gaussian_low_pass(map, nesting_index);
}

HeightMap difference(const LevelledPair& treated) {
    const HeightMap result = less(treated.measured, treated.truth);
    // Levelled maps differ by a levelled map; after an L-filter a rest of offset and tilt may remain.
    return surface::remove_plane(result, surface::least_squares_plane(result));
}

} // namespace

LevelledPair levelled_pair(HeightMap measured, HeightMap truth, const Band& band) {
    if (measured.columns() != truth.columns() || measured.rows() != truth.rows())
        throw std::invalid_argument("compare: both height maps must stand on the same grid");
    for (std::size_t k = 0; k < measured.height.values.size(); ++k) {
        double& a = measured.height.values[k];
        double& b = truth.height.values[k];
        if (!std::isfinite(a) || !std::isfinite(b))
            a = b = std::numeric_limits<double>::quiet_NaN();
    }
    const auto level = [&band](HeightMap map) {
        const surface::Plane plane = surface::least_squares_plane(map);
        map = surface::remove_plane(std::move(map), plane);
        if (band.s_filter > 0)
            map = low_pass(map, band.s_filter, band.spline);
        if (band.l_filter > 0)
            map = less(map, low_pass(map, band.l_filter, band.spline));
        return map;
    };
    return {level(std::move(measured)), level(std::move(truth))};
}

Deviation compare(const HeightMap& measured, const HeightMap& truth, const Band& band) {
    const LevelledPair treated = levelled_pair(measured, truth, band);
    const auto a = surface::height_parameters(treated.measured);
    const auto b = surface::height_parameters(treated.truth);
    double covariance = 0, count = 0;
    for (std::size_t k = 0; k < treated.measured.height.values.size(); ++k)
        if (const double z = treated.measured.height.values[k]; std::isfinite(z)) {
            covariance += (z - a.mean) * (treated.truth.height.values[k] - b.mean);
            count += 1;
        }
    Deviation result;
    result.sq_measured = a.sq;
    result.sq_true = b.sq;
    result.rms = surface::height_parameters(difference(treated)).sq;
    if (count == 0)
        result.correlation = std::numeric_limits<double>::quiet_NaN();
    else if (a.sq > 0 && b.sq > 0)
        result.correlation = covariance / count / (a.sq * b.sq);
    result.measured_share = a.measured_share;
    return result;
}

HeightMap deviation_map(const HeightMap& measured, const HeightMap& truth, const Band& band) {
    return difference(levelled_pair(measured, truth, band));
}

} // namespace vkfv::topography
