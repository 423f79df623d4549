// Random numbers of a camera, without a state that images share: a number is a function of the camera's seed, the
// image, the pixel, the frame and what it is for (shaders/physics/random.glsl, Philox), so that an image has the same
// bits whichever is taken first, and on however many threads.
#pragma once

#include "physics/physics.hpp"

#include <array>
#include <cstdint>

namespace vkfv::camera {

// What numbers are for: the last word of the generator's counter, which is 0 for the paths of light.
enum class Purpose : std::uint32_t { temporal_noise = 1, photo_response = 2, dark_signal = 3 };

class RandomStream {
  public:
    // Of a pixel's fixed patterns image and frame are 0.
    RandomStream(std::uint32_t seed, std::uint32_t image, std::uint32_t pixel, std::uint32_t frame, Purpose purpose)
        : seed_(seed), image_(image), counter_(pixel, frame, 0, static_cast<std::uint32_t>(purpose)) {}

    // Two independent numbers, uniform in (0, 1): the middles of 2^52 equal cells.
    std::array<double, 2> uniforms();
    // Of mean 0 and standard deviation 1.
    double normal();

  private:
    std::uint32_t seed_;
    std::uint32_t image_;
    glm::uvec4 counter_;
};

} // namespace vkfv::camera
