// Rays for the tests of this room.
#pragma once

#include <glm/glm.hpp>

#include <cmath>
#include <cstdint>
#include <random>

namespace vkfv::test {

class RandomRays {
  public:
    explicit RandomRays(std::uint64_t seed) : generator_(seed) {}

    double uniform(double lower, double upper) {
        return lower + (upper - lower) * (static_cast<double>(generator_() >> 11) + 0.5) * 0x1p-53;
    }
    // A unit vector with its polar angle to +z between the two, uniform over the solid angle.
    glm::dvec3 direction(double least_angle, double largest_angle) {
        const double z = uniform(std::cos(largest_angle), std::cos(least_angle));
        const double phi = uniform(0, 6.283185307179586);
        const double r = std::sqrt(1 - z * z);
        return {r * std::cos(phi), r * std::sin(phi), z};
    }

  private:
    std::mt19937_64 generator_;
};

} // namespace vkfv::test
