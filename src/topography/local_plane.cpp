#include "topography/local_plane.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>

namespace vkfv::topography {

LocalPlane plane_of(const PlaneMoments& m) {
    if (!(m.weight > 0)) {
        return {};
    }
    const double sxx = m.about_means(m.xx, m.x, m.x), sxy = m.about_means(m.xy, m.x, m.y),
                 syy = m.about_means(m.yy, m.y, m.y);
    const double sxz = m.about_means(m.xz, m.x, m.z), syz = m.about_means(m.yz, m.y, m.z);
    const double determinant = sxx * syy - sxy * sxy;
    constexpr double least = 1e-3; // share of the two moments' product: heights along a line determine no plane
    if (!(determinant > least * sxx * syy)) {
        return {.middle = m.z / m.weight};
    }
    LocalPlane plane{.rise_x = (syy * sxz - sxy * syz) / determinant, .rise_y = (sxx * syz - sxy * sxz) / determinant};
    plane.middle = (m.z - plane.rise_x * m.x - plane.rise_y * m.y) / m.weight;
    return plane;
}

Grid<double> near_zero(Grid<double> height) {
    const auto first = std::ranges::find_if(height.values, [](double z) { return std::isfinite(z); });
    const double common = first == height.values.end() ? 0 : *first;
    for (double& z : height.values) {
        z -= common;
    }
    return height;
}

PlaneRow::PlaneRow(const Grid<double>& height, std::span<const double> weights)
    : height_(height), weights_(weights), columns_(static_cast<std::size_t>(height.columns)) {}

void PlaneRow::move_to(int row) {
    const int reach = static_cast<int>(weights_.size()) - 1;
    for (int column = 0; column < height_.columns; ++column) {
        PlaneMoments sums;
        for (int d = -std::min(reach, row); d <= std::min(reach, height_.rows - 1 - row); ++d) {
            const double z = height_(column, row + d);
            if (std::isfinite(z)) {
                const double weight = weights_[static_cast<std::size_t>(std::abs(d))];
                sums.weight += weight;
                sums.y += weight * d;
                sums.yy += weight * d * d;
                sums.z += weight * z;
                sums.yz += weight * d * z;
                sums.zz += weight * z * z;
            }
        }
        columns_[static_cast<std::size_t>(column)] = sums;
    }
}

PlaneMoments PlaneRow::at(int column) const {
    const int reach = static_cast<int>(weights_.size()) - 1;
    PlaneMoments all;
    for (int d = -std::min(reach, column); d <= std::min(reach, height_.columns - 1 - column); ++d) {
        const int place = column + d;
        const PlaneMoments& here = columns_[static_cast<std::size_t>(place)];
        const double weight = weights_[static_cast<std::size_t>(std::abs(d))];
        all.weight += weight * here.weight;
        all.y += weight * here.y;
        all.yy += weight * here.yy;
        all.z += weight * here.z;
        all.yz += weight * here.yz;
        all.zz += weight * here.zz;
        all.x += weight * d * here.weight;
        all.xx += weight * d * d * here.weight;
        all.xy += weight * d * here.y;
        all.xz += weight * d * here.z;
    }
    return all;
}

} // namespace vkfv::topography
