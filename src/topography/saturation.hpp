// Where a camera cut values off: as many pixels have the largest value as would have it and many others above it.
#pragma once

#include <cstddef>
#include <limits>
#include <span>

namespace vkfv::topography {

struct Saturation {
    float level = std::numeric_limits<float>::infinity(); // of the values that are cut off, in the images' unit
    double share = 0;                                     // of all values
};

// Counts values as they come.
class SaturationCount {
  public:
    void add(std::span<const float> values);

    // The largest value, if it is there far more often than those just below it.
    Saturation found() const;

  private:
    float largest_ = 0;
    std::size_t there_ = 0; // with the largest value
    std::size_t below_ = 0; // with less, but hardly
    std::size_t all_ = 0;
};

} // namespace vkfv::topography
