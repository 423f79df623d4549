// Saturation: the level at which a camera clips values. Pixels that are brighter have this value too, so it is far more
// frequent than the grey levels just below.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>

namespace vkfv::topography {

struct Saturation {
    float level = std::numeric_limits<float>::infinity(); // level at which values are clipped, in the images' unit
    double share = 0;                                     // share of saturated values
};

// Counts values as they come. A file's largest integer is 1.
class SaturationCount {
  public:
    void add(std::span<const float> values);

    // The largest value, if it occurs several times as often as each of the grey levels just below it.
    Saturation found() const;

  private:
    struct Level {
        float value = -std::numeric_limits<float>::infinity();
        std::size_t values = 0; // number of values equal to it
    };
    void count(float value);

    std::array<Level, 5> levels_; // the largest grey levels, the largest first
    std::size_t all_ = 0;
};

} // namespace vkfv::topography
