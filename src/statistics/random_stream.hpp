// Random numbers without shared state: a number is a function of the seed, the image, the element (a camera's pixel, or
// another of many parts of an image), the round (a camera's frame) and its purpose (shaders/physics/random.glsl,
// Philox), so that an image has the same bits in whatever order images are taken, and on any number of threads.
#pragma once

#include "physics/physics.hpp"

#include <array>
#include <cstdint>

namespace vkfv::statistics {

// The purpose of a number: the last word of the generator's counter, which is 0 for the paths of light.
enum class Purpose : std::uint32_t {
    temporal_noise = 1, // this and the next two: of a camera
    photo_response = 2,
    dark_signal = 3,
    emission_order = 4, // this and the next: of the trace
    emission_order_rest = 5,
    uncertain_input = 6 // of a trial of a budget
};

class RandomStream {
  public:
    // Starts a stream. For fixed patterns of pixels image and round are 0.
    RandomStream(std::uint32_t seed, std::uint32_t image, std::uint32_t element, std::uint32_t round, Purpose purpose)
        : seed_(seed), image_(image), counter_(element, round, 0, static_cast<std::uint32_t>(purpose)) {}

    // Two independent numbers, uniform in (0, 1): the middles of 2^52 equal cells.
    std::array<double, 2> uniforms();
    // A normal deviate of mean 0 and standard deviation 1.
    double normal();

  private:
    std::uint32_t seed_;
    std::uint32_t image_;
    glm::uvec4 counter_;
};

} // namespace vkfv::statistics
