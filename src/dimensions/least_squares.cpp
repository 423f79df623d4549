#include "dimensions/least_squares.hpp"

#include <Eigen/Dense>

namespace vkfv::dimensions {

void LeastSquares::add(std::span<const double> functions, double value) {
    for (std::size_t row = 0; row < n_; ++row) {
        for (std::size_t column = row; column < n_; ++column)
            matrix_[row * n_ + column] += functions[row] * functions[column];
        right_[row] += functions[row] * value;
    }
}

std::optional<LeastSquares::Solution> LeastSquares::solve() const {
    const auto n = static_cast<Eigen::Index>(n_);
    Eigen::MatrixXd matrix(n, n);
    Eigen::VectorXd right(n);
    for (Eigen::Index row = 0; row < n; ++row) {
        right[row] = right_[static_cast<std::size_t>(row)];
        for (Eigen::Index column = row; column < n; ++column)
            matrix(row, column) = matrix(column, row) =
                matrix_[static_cast<std::size_t>(row) * n_ + static_cast<std::size_t>(column)];
    }
    // Unknowns of different magnitude are scaled to one.
    const Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
    if (!scale.allFinite())
        return std::nullopt;
    const Eigen::MatrixXd scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
    const Eigen::FullPivLU<Eigen::MatrixXd> decomposition(scaled);
    if (!decomposition.isInvertible() || decomposition.rcond() < 1e-13)
        return std::nullopt;
    const Eigen::VectorXd unknowns = scale.asDiagonal() * decomposition.solve(scale.asDiagonal() * right);
    const Eigen::MatrixXd inverse = scale.asDiagonal() * decomposition.inverse() * scale.asDiagonal();
    const Eigen::VectorXd variances = inverse.diagonal();
    return Solution{{unknowns.begin(), unknowns.end()},
                    {variances.begin(), variances.end()},
                    // The storage order of the inverse does not matter, as it is symmetric.
                    {inverse.data(), inverse.data() + inverse.size()}};
}

} // namespace vkfv::dimensions
