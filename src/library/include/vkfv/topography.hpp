// The heights that a stack was evaluated to.
#pragma once

#include <cstdint>
#include <vector>

namespace vkfv {

// Arrays lie as those of Image. NaN: not measured, or without a truth.
struct Topography {
    int columns = 0;
    int rows = 0;
    double x0_um = 0; // of point (0, 0), in the specimen's frame
    double y0_um = 0;
    double pitch_um = 0;
    std::vector<double> heights_um;
    std::vector<double> height_uncertainty_um; // standard uncertainty, including noise
    std::vector<double> height_noise_um;       // standard deviation by the noise of the images
    std::vector<double> contrast;              // dimensionless
    std::vector<double> truth_um;              // the specimen's own height where the pixel looks; empty: there is none
    std::vector<std::uint8_t> measured;        // 1: measured, 0: not
};

} // namespace vkfv
