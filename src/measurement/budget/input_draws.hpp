// Values of the uncertain numbers of a configuration, drawn for trials of a measurement (JCGM 101, clause 6).
#pragma once

#include "configuration/configuration.hpp"

#include <cstdint>
#include <vector>

namespace vkfv::measurement {

// Draws from the inputs' distributions. A draw is a function of the seed, the trial and the input, so trials have the
// same draws in whatever order they are measured, and more trials leave the first ones as they were.
class InputDraws {
  public:
    // Throws InputError for correlations that no distribution has.
    InputDraws(const Uncertainty& uncertainty, std::uint32_t seed);

    // The deviations of all inputs from their values, each in its own unit.
    std::vector<double> deviations(std::uint32_t trial) const;

  private:
    Uncertainty uncertainty_;
    std::uint32_t seed_;
    std::vector<double> root_; // matrix whose product with its transpose is the correlation; row by row
};

} // namespace vkfv::measurement
