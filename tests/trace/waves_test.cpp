// The image that waves make of light sorted by pupil cells.
#include "optics/assembly.hpp"
#include "trace/device_wave_image.hpp"
#include "trace/wave_image.hpp"

#include "microscope.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

using namespace vkfv;

namespace {

std::vector<std::uint64_t> noisy_light(std::size_t numbers) {
    std::mt19937_64 random(1);
    std::poisson_distribution<std::uint64_t> count(20);
    std::vector<std::uint64_t> light(numbers);
    std::generate(light.begin(), light.end(), [&] { return count(random); });
    return light;
}

} // namespace
