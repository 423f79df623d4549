// Images and stacks of them, in memory.
#pragma once

#include <vector>

namespace vkfv {

// An exposure. Arrays hold the value of column i and row j at [j * columns + i]; x ascends with the column and y with
// the row in the specimen's frame, so row 0 has the lowest y. (Files that vkfv writes begin with the highest y.)
struct Image {
    int columns = 0;
    int rows = 0;
    double x0_um = 0; // of the middle of pixel (0, 0) on the specimen
    double y0_um = 0;
    double pitch_um = 0;
    double z_um = 0;                    // height of the focal plane
    std::vector<float> flux;            // W a pixel, as the command's files hold it
    std::vector<double> standard_error; // W, of the flux
};

// The images of a scan in its order.
struct Stack {
    std::vector<Image> images;
};

} // namespace vkfv
