// The errors of a stage in the positions of a stack, for the stack's results.
#pragma once

#include "configuration/configuration.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>

namespace vkfv::measurement {

// The scale's reading (mm) at an image of the configuration's stack, if heights are evaluated by readings; without one
// they are evaluated by nominal positions.
std::optional<double> reading_of(const Configuration& configuration, double position, int image);

// Errors over the images of a stack with a stage, mm: of the focal planes from their nominal positions, and the largest
// displacement of the specimen at right angles to the axis.
struct StageErrors {
    double rms = 0, largest = 0, largest_aside = 0;
};
StageErrors stage_errors(const Configuration& configuration);

// The results of a stack with a stage: members of results.json, and a CSV file beside the heights with a line for each
// image.
inline constexpr const char* stage_file = "stage.csv";
nlohmann::ordered_json stage_figures(const Configuration& configuration);
std::string stage_table(const Configuration& configuration);

} // namespace vkfv::measurement
