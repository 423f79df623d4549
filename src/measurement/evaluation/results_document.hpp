// results.json: the figures of an evaluated stack, and what earlier results say of the trace.
#pragma once

#include "measurement/evaluation/evaluation_figures.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string_view>
#include <vector>

namespace vkfv::measurement {

// Of an evaluated stack, in its folder.
inline constexpr std::string_view results_name = "results.json";

// All but the origin of the images. plain, diffracted: figures_of() the evaluation and of that within it, if there is
// one.
nlohmann::ordered_json results_of(const Evaluation& evaluation, const std::vector<Figures>& plain,
                                  const std::vector<Figures>& diffracted);

// What the results in a stack's folder say of the trace: device, digest, seed and counts; none if there are no results.
nlohmann::ordered_json run_of(const std::filesystem::path& folder);

} // namespace vkfv::measurement
