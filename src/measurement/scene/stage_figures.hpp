// A stage's errors in a stack's positions, for its results.
#pragma once

#include "configuration/configuration.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>

namespace vkfv::measurement {

// What the scale reads of an image of the configuration's stack, where heights are told by that, mm; none: they are by
// the nominal positions.
std::optional<double> reading_of(const Configuration& configuration, double position, int image);

// Over the images of a stack with a stage, mm: of the focal planes from the nominal positions, and of the specimen at
// right angles to the axis.
struct StageErrors {
    double rms = 0, largest = 0, largest_aside = 0;
};
StageErrors stage_errors(const Configuration& configuration);

// Of a stack with a stage: for results.json, and its file beside the heights, a line an image.
inline constexpr const char* stage_file = "stage.csv";
nlohmann::ordered_json stage_figures(const Configuration& configuration);
std::string stage_table(const Configuration& configuration);

} // namespace vkfv::measurement
