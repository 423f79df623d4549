// Numbers that deviate together.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace vkfv::statistics {

// A matrix R with R R^T = correlation, both row by row (Cholesky, with pivots): R times independent deviates of
// standard deviation 1 are deviates with these correlations. Coefficients of 1 and -1 are correlations too. None if the
// matrix has a negative eigenvalue, beyond rounding.
std::optional<std::vector<double>> correlation_root(const std::vector<double>& correlation, std::size_t count);

} // namespace vkfv::statistics
