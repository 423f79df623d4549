// Linear least squares with a few unknowns and very many points.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace vkfv::dimensions {

class LeastSquares {
  public:
    explicit LeastSquares(std::size_t unknowns) : n_(unknowns), matrix_(unknowns * unknowns), right_(unknowns) {}

    // The functions' values at a point, one for each unknown, and what their sum is to be.
    void add(std::span<const double> functions, double value);

    struct Solution {
        std::vector<double> unknowns;
        std::vector<double> variances; // for independent points of unit variance
        std::vector<double> inverse;   // of the normal matrix, n x n: their covariances
    };
    // None where the points leave an unknown open.
    std::optional<Solution> solve() const;

  private:
    std::size_t n_;
    std::vector<double> matrix_, right_; // of the normal equations, upper triangle
};

} // namespace vkfv::dimensions
