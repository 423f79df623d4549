#include "surface/profile.hpp"

#include "surface/filter.hpp"
#include "surface/height_parameters.hpp"
#include "surface/material_ratio.hpp"
#include "surface/profile_elements.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace vkfv::surface {
namespace {

constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

// The position of a coordinate along an axis, in pitches from the first point.
double place(double coordinate, double first, double pitch) {
    const double exact = (coordinate - first) / pitch, nearest = std::round(exact);
    // A grid point is hit exactly, in spite of the rounding of its coordinates.
    return std::abs(exact - nearest) < 1e-9 * std::max(1.0, std::abs(nearest)) ? nearest : exact;
}

double bilinear(const HeightMap& map, double x, double y) {
    const double column = place(x, map.x0, map.pitch_x), row = place(y, map.y0, map.pitch_y);
    if (!(column >= 0 && column <= map.columns() - 1 && row >= 0 && row <= map.rows() - 1))
        return not_measured;
    const int i = static_cast<int>(column), k = static_cast<int>(row);
    const double u = column - i, v = row - k;
    double sum = 0;
    const auto add = [&](int i_, int k_, double weight) {
        if (weight > 0)
            sum += weight * map.height(i_, k_);
    };
    add(i, k, (1 - u) * (1 - v));
    add(i + 1, k, u * (1 - v));
    add(i, k + 1, (1 - u) * v);
    add(i + 1, k + 1, u * v);
    return std::isfinite(sum) ? sum : not_measured;
}

// A map of one row, to which the areal filters apply.
HeightMap row_of(std::vector<double> heights, double spacing) {
    HeightMap map{.height = Grid<double>(static_cast<int>(heights.size()), 1),
                  .x0 = 0,
                  .y0 = 0,
                  .pitch_x = spacing,
                  .pitch_y = spacing};
    map.height.values = std::move(heights);
    return map;
}

double root_mean_square_slope(const Profile& profile) {
    double sum = 0, count = 0;
    for (std::size_t k = 1; k < profile.height.size(); ++k)
        if (const double slope = (profile.height[k] - profile.height[k - 1]) / profile.spacing; std::isfinite(slope)) {
            sum += slope * slope;
            count += 1;
        }
    return count > 0 ? std::sqrt(sum / count) : not_measured;
}

} // namespace

HeightMap map_of(const Profile& profile) {
    return row_of(profile.height, profile.spacing);
}

Profile extract_profile(const HeightMap& map, double x_start, double y_start, double x_end, double y_end,
                        double spacing) {
    if (!(spacing > 0))
        throw std::invalid_argument("extract_profile: the spacing must be positive");
    const double length = std::hypot(x_end - x_start, y_end - y_start);
    const int last = static_cast<int>(std::floor(place(length, 0, spacing)));
    Profile profile{.height = {}, .spacing = spacing};
    for (int k = 0; k <= last; ++k) {
        const double share = last > 0 ? k * spacing / length : 0;
        profile.height.push_back(bilinear(map, std::lerp(x_start, x_end, share), std::lerp(y_start, y_end, share)));
    }
    return profile;
}

Profile gaussian_low_pass(const Profile& profile, double nesting_index) {
    return {gaussian_low_pass(row_of(profile.height, profile.spacing), nesting_index).height.values, profile.spacing};
}

Profile remove_long_waves(const Profile& profile, double nesting_index) {
    return {remove_long_waves(row_of(profile.height, profile.spacing), nesting_index).height.values, profile.spacing};
}

ProfileParameters profile_parameters(const Profile& profile, int sections) {
    if (sections < 1)
        throw std::invalid_argument("profile_parameters: at least one section");
    const HeightParameters heights = height_parameters(row_of(profile.height, profile.spacing));
    const MaterialRatioCurve curve(row_of(profile.height, profile.spacing));
    const CoreParameters core = core_parameters(curve);
    ProfileParameters result{.ra = heights.sa,
                             .rq = heights.sq,
                             .rz = 0,
                             .rp = 0,
                             .rv = 0,
                             .rt = heights.sz,
                             .rsk = heights.ssk,
                             .rku = heights.sku,
                             .rdq = root_mean_square_slope(profile),
                             .rdc = ratio_parameters(curve).sdc,
                             .rk = core.sk,
                             .rpk = core.spk,
                             .rvk = core.svk,
                             .rmrk1 = core.smr1,
                             .rmrk2 = core.smr2};
    const auto points = profile.height.size(), count = static_cast<std::size_t>(sections);
    for (std::size_t section = 0; section < count; ++section) {
        double highest = not_measured, lowest = not_measured;
        for (std::size_t k = points * section / count; k < points * (section + 1) / count; ++k) {
            highest = std::fmax(highest, profile.height[k]);
            lowest = std::fmin(lowest, profile.height[k]);
        }
        result.rz += (highest - lowest) / sections;
        result.rp += (highest - heights.mean) / sections;
        result.rv += (heights.mean - lowest) / sections;
    }
    const ProfileElements elements = profile_elements(profile, heights.mean, 0.1 * result.rz);
    result.rsm = elements.mean_spacing;
    result.rc = elements.mean_height;
    return result;
}

} // namespace vkfv::surface
