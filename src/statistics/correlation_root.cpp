#include "statistics/correlation_root.hpp"

#include <Eigen/Cholesky>

namespace vkfv::statistics {

std::optional<std::vector<double>> correlation_root(const std::vector<double>& correlation, std::size_t count) {
    using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const auto side = static_cast<Eigen::Index>(count);
    std::vector<double> root(correlation.size());
    if (count == 0) {
        return root;
    }
    const Eigen::Map<const Matrix> wanted(correlation.data(), side, side);
    const Eigen::LDLT<Matrix> cholesky(wanted);
    const Eigen::VectorXd pivots = cholesky.vectorD().cwiseMax(0.0).cwiseSqrt();
    const Matrix triangle = Matrix(cholesky.matrixL()) * pivots.asDiagonal();
    const Matrix found = cholesky.transpositionsP().transpose() * triangle;
    constexpr double rounding = 1e-10; // of coefficients as users write them
    if (!((found * found.transpose() - wanted).cwiseAbs().maxCoeff() < rounding)) {
        return std::nullopt;
    }
    Eigen::Map<Matrix>(root.data(), side, side) = found;
    return root;
}

} // namespace vkfv::statistics
