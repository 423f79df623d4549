// Numbers that deviate together.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace vkfv::statistics {

// The lower triangle L with L L^T = correlation, both row by row (Cholesky): L times independent deviates of standard
// deviation 1 are deviates with these correlations. None if the matrix is not positive definite.
std::optional<std::vector<double>> correlation_root(const std::vector<double>& correlation, std::size_t count);

} // namespace vkfv::statistics
