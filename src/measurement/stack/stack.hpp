// Measurement of a stack as the instrument does it: exposures over a scan, evaluated and compared with the truth.
#pragma once

#include "configuration/configuration.hpp"
#include "core/messages/progress.hpp"
#include "measurement/evaluation/evaluation.hpp"
#include "scan/stack.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace vkfv::measurement {

struct StackResult {
    Evaluation evaluation;
    scan::StackSummary traced;        // images that this run traced or found
    std::uint64_t rays_per_image = 0; // launched
    std::filesystem::path folder;     // of the images and all results
    std::string device{};             // device that traced the images; empty: not known
};

// Reads the configuration of a stack as load_configuration() does. Where it leaves the estimator to vkfv ("auto"), a
// stack that was begun in the output folder is continued by its own estimator.
Configuration load_stack(const std::filesystem::path& file, const std::vector<TomlOverride>& overrides);

// Traces the images that the output folder lacks of the configuration's stack, evaluates all of them, and writes the
// results there (write_results()). Images kept from an earlier run give the same result as those traced now. Throws
// InputError, DeviceError, and RunError after which the same call continues.
StackResult measure_stack(const Configuration& configuration, Progress& progress);

// Traces the images that the output folder lacks of this shard. It evaluates nothing; merge_stack() does when all
// images are there. Throws as measure_stack().
struct ShardResult {
    scan::Shard shard;
    scan::StackSummary traced;
    std::filesystem::path folder;
};
ShardResult trace_shard(const Configuration& configuration, scan::Shard shard, Progress& progress);
std::string summary(const ShardResult& shard);
nlohmann::ordered_json shard_json(const ShardResult& shard);

// Puts the images of a stack's shards into one folder, which may hold some of them already, and evaluates them to the
// same bytes as a run that traces all of them. Needs no device; without the device that traced, a warning tells that
// the heights of a GPU may differ in their last digits. shards: other folders of the same stack, which are left as they
// are. Throws InputError where a shard is of another configuration, program or device, an image is not whole, or some
// images are missing.
StackResult merge_stack(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& shards);

// A text of a few lines with figures, times and the folder.
std::string summary(const StackResult& stack);

} // namespace vkfv::measurement
