// Least-squares planes around every point of a height map, by running sums.
#pragma once

#include "core/mathematics/grid.hpp"

#include <span>
#include <vector>

namespace vkfv::topography {

// Weighted moments of the finite heights around a point; x and y count in pixels from it. Heights in any unit.
struct PlaneMoments {
    double weight = 0;
    double x = 0;
    double y = 0;
    double xx = 0;
    double xy = 0;
    double yy = 0;
    double z = 0;
    double xz = 0;
    double yz = 0;
    double zz = 0;

    // A moment about the means, from the sum of products and the sums of both factors.
    double about_means(double product, double a, double b) const { return product - a * b / weight; }
};

// Rise of height a pixel along x and y, and the height of the plane at the point itself.
struct LocalPlane {
    double rise_x = 0;
    double rise_y = 0;
    double middle = 0;
};

// The least-squares plane; where the heights lie along a line, or there are none: level, at their mean.
LocalPlane plane_of(const PlaneMoments& moments);

// The heights minus one of the finite ones: sums of squares would lose digits to a height that all have in common.
Grid<double> near_zero(Grid<double> height);

// The moments around the points of a row, for one row after another, of heights near zero.
class PlaneRow {
  public:
    // weights: of a row or column at this distance from the point, from 0 on; a height's weight is the product of both.
    // height and weights must outlive this.
    PlaneRow(const Grid<double>& height, std::span<const double> weights);

    void move_to(int row);
    // The moments around a point of the row moved to.
    PlaneMoments at(int column) const;

  private:
    const Grid<double>& height_;
    std::span<const double> weights_;
    std::vector<PlaneMoments> columns_; // moments of each column about x = 0
};

} // namespace vkfv::topography
