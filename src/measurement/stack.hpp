// A stack as the instrument takes it: exposures over a scan, evaluated and compared with the truth.
#pragma once

#include "configuration/configuration.hpp"
#include "core/progress.hpp"
#include "measurement/evaluation.hpp"
#include "scan/stack.hpp"

#include <cstdint>
#include <filesystem>
#include <string>

namespace vkfv::measurement {

struct StackResult {
    Evaluation evaluation;
    scan::StackSummary traced;        // what this run traced, and what was there
    std::uint64_t rays_per_image = 0; // launched
    std::filesystem::path folder;     // that holds the images and all results
};

// Traces what the output folder lacks of the stack that the configuration asks for, evaluates all of it, and writes the
// results there (write_results()). Images kept from an earlier run give the same result as those traced now. Throws
// InputError, DeviceError, and RunError after which the same call continues.
StackResult measure_stack(const Configuration& configuration, Progress& progress);

// The figures, times and folder as a text of a few lines.
std::string summary(const StackResult& stack);

} // namespace vkfv::measurement
