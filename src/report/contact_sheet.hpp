// Images of a parameter variation side by side.
#pragma once

#include "core/mathematics/grid.hpp"

#include <string>
#include <vector>

namespace vkfv::report {

// Images in rows and columns, each stretched from black at 0 to white at `brightest` times its own mean, so that
// images of different flux can be compared in their noise and contrast.
struct ContactSheet {
    std::string title;
    std::string row_label, column_label;                // names of the varied parameters: "g"
    std::vector<std::string> row_values, column_values; // values of the parameters in each row and column
    std::vector<Grid<float>> images;                    // row by row, the first row on top; one size
    std::vector<std::string> notes;                     // under each image
    double brightest = 2;
};

std::string contact_sheet(const ContactSheet& sheet);

} // namespace vkfv::report
