#include "statistics/correlation_root.hpp"

#include <Eigen/Cholesky>

namespace vkfv::statistics {

std::optional<std::vector<double>> correlation_root(const std::vector<double>& correlation, std::size_t count) {
    using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const auto side = static_cast<Eigen::Index>(count);
    const Eigen::LLT<Matrix> cholesky(Eigen::Map<const Matrix>(correlation.data(), side, side));
    if (count > 0 && cholesky.info() != Eigen::Success) {
        return std::nullopt;
    }
    std::vector<double> root(correlation.size());
    Eigen::Map<Matrix>(root.data(), side, side) = cholesky.matrixL().toDenseMatrix();
    return root;
}

} // namespace vkfv::statistics
