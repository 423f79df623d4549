// Linear least squares with a few unknowns and very many points.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace vkfv::dimensions {

class LeastSquares {
  public:
    explicit LeastSquares(std::size_t unknowns) : n_(unknowns), matrix_(unknowns * unknowns), right_(unknowns) {}

    // Adds a point: the functions' values there, one for each unknown, and the value that their weighted sum should
    // have.
    void add(std::span<const double> functions, double value);

    struct Solution {
        std::vector<double> unknowns;
        std::vector<double> variances; // for independent points of unit variance
        std::vector<double> inverse;   // inverse of the normal matrix, n x n: covariances of the unknowns
    };
    // The solution; none if the points leave an unknown undetermined.
    std::optional<Solution> solve() const;

  private:
    std::size_t n_;
    std::vector<double> matrix_, right_; // normal equations, upper triangle
};

} // namespace vkfv::dimensions
