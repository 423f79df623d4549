// A small matrix of numbers, row by row.
#pragma once

#include <cstddef>
#include <vector>

namespace vkfv::statistics {

struct Matrix {
    std::size_t rows = 0;
    std::size_t columns = 0;
    std::vector<double> values{};

    Matrix() = default;
    Matrix(std::size_t rows_, std::size_t columns_) : rows(rows_), columns(columns_), values(rows_ * columns_) {}
    double& operator()(std::size_t row, std::size_t column) { return values[row * columns + column]; }
    const double& operator()(std::size_t row, std::size_t column) const { return values[row * columns + column]; }
};

} // namespace vkfv::statistics
