// Least-squares surfaces of second degree around every point of a height map, by running sums.
#pragma once

#include "core/mathematics/grid.hpp"

#include <array>
#include <span>
#include <vector>

namespace vkfv::topography {

// The surfaces around the points of a row, for one row after another, of heights near zero (near_zero() of
// local_plane.hpp).
class QuadricRow {
  public:
    // weights: of a row or column at this distance from the point, from 0 on, two at least; a height's weight is the
    // product of both. height and weights must outlive this.
    QuadricRow(const Grid<double>& height, std::span<const double> weights);

    void move_to(int row);
    // The height of the least-squares surface a x^2 + b x y + c y^2 + d x + e y + f at a point of the row moved to. NaN
    // where the weights reach beyond the map, where its finite heights have less than half of the weight, and where
    // they do not determine the surface.
    double middle(int column) const;

    // If all heights around are finite, middle() is the sum of weight(x) weight(y) (constant + square (x^2 + y^2)) z,
    // with x and y in pixels.
    struct Whole {
        double constant = 0;
        double square = 0;
    };
    Whole whole() const;

  private:
    static constexpr int powers = 5, terms = 6;
    // Sums along a column, of weights and of weighted heights, by the power of the distance from the row.
    struct Column {
        std::array<double, powers> weight{};
        std::array<double, 3> height{};
    };
    using Terms = std::array<double, terms>;
    // Factors on the sums of z, x z, y z, x x z, x y z, y y z whose total is the height at the point, for these moments
    // of x^p y^q at [p][q]; NaN where these do not determine the surface.
    static Terms factors_of(const std::array<std::array<double, powers>, powers>& moments);

    double distance(int d) const { return d / static_cast<double>(weights_.size() - 1); }

    const Grid<double>& height_;
    std::span<const double> weights_;
    std::vector<Column> columns_;
    int row_ = 0;
    double whole_ = 0; // total weight if all heights around are finite
    Terms of_whole_{};
};

} // namespace vkfv::topography
