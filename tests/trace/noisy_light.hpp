// Light of waves that is nothing but the noise of its rays.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace vkfv::test {

// Independent Poisson counts of this mean, the same numbers at every call.
inline std::vector<std::uint64_t> noisy_light(std::size_t numbers, double mean) {
    std::mt19937_64 random(1);
    std::poisson_distribution<std::uint64_t> count(mean);
    std::vector<std::uint64_t> light(numbers);
    std::generate(light.begin(), light.end(), [&] { return count(random); });
    return light;
}

} // namespace vkfv::test
