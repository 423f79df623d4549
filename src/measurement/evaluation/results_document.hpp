// The document results.json: the figures of an evaluated stack, and what earlier results say of the trace.
#pragma once

#include "core/messages/warning.hpp"
#include "measurement/evaluation/evaluation_figures.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string_view>
#include <vector>

namespace vkfv::measurement {

// The name of the results' file in the folder of an evaluated stack.
inline constexpr std::string_view results_name = "results.json";

// The document, which lacks only the origin of the images. plain, diffracted: figures_of() of the evaluation, and of
// its `diffracted` one if there is one.
nlohmann::ordered_json results_of(const Evaluation& evaluation, const std::vector<Figures>& plain,
                                  const std::vector<Figures>& diffracted);

// The figures of the trace (device, digest, seed and counts) in an earlier results.json of the folder; an empty object
// if there is no such file.
nlohmann::ordered_json run_of(const std::filesystem::path& folder);
// The warnings in an earlier results.json that concern the images' light and camera, which cannot be found again
// without tracing.
std::vector<Warning> warnings_of_run(const std::filesystem::path& folder);

} // namespace vkfv::measurement
