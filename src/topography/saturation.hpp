// Saturation: the level at which a camera clips values. Pixels that are brighter have this value too, so it is far more
// frequent than values just below.
#pragma once

#include <cstddef>
#include <limits>
#include <span>

namespace vkfv::topography {

struct Saturation {
    float level = std::numeric_limits<float>::infinity(); // level at which values are clipped, in the images' unit
    double share = 0;                                     // share of saturated values
};

// Counts values as they come.
class SaturationCount {
  public:
    void add(std::span<const float> values);

    // The largest value, if it occurs far more often than values just below it.
    Saturation found() const;

  private:
    float largest_ = 0;
    std::size_t there_ = 0; // number of values equal to the largest
    std::size_t below_ = 0; // number of values just below the largest
    std::size_t all_ = 0;
};

} // namespace vkfv::topography
