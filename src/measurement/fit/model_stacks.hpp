// Stacks that a configuration makes with other numbers and other seeds, of which the statistics alone are kept.
#pragma once

#include "configuration/configuration.hpp"
#include "core/files/result_folder.hpp"
#include "core/messages/progress.hpp"
#include "measurement/fit/free_parameter.hpp"
#include "measurement/fit/stack_statistics.hpp"
#include "measurement/stack/stack_runs.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace vkfv::measurement {

// The stacks of a fit. Each is traced once: its statistics are a file runs/DIGEST.json in the results, named by all
// that they depend on, and its images, in tracing/DIGEST, are removed when they are there. So the same fit continues,
// and a fit of other keys takes what it has in common.
class ModelStacks {
  public:
    // base: of the file with the overrides. All references must outlive the object.
    ModelStacks(const Configuration& base, std::filesystem::path file, std::vector<TomlOverride> overrides,
                const std::vector<FreeParameter>& parameters, const StatisticsLayout& layout, ResultFolder& results,
                Progress& progress);

    // The configuration of a stack. Each seed changes all that a repeated measurement of another specimen of this kind
    // would draw anew: rays, noise, errors of the stage, roughness and texture; none is the base's own. Throws
    // InputError for numbers that the configuration refuses, or by which it makes other images than the layout has.
    Configuration configuration(const std::vector<double>& place, int seed) const;

    // The statistics of that stack. Throws as configuration() and StackRuns::trace() do.
    std::vector<double> statistics(const std::vector<double>& place, int seed);

    int stacks() const { return stacks_; }                            // asked for, of this fit
    int traced() const { return traced_; }                            // of these, by this run
    const std::set<std::string>& devices() const { return devices_; } // that traced

  private:
    const Configuration& base_;
    std::filesystem::path file_;
    std::vector<TomlOverride> overrides_;
    const std::vector<FreeParameter>& parameters_;
    StatisticsLayout layout_;
    ResultFolder& results_;
    Progress& progress_;
    std::map<std::string, std::uint32_t> seeds_; // of the base, by key
    StackRuns runs_;
    std::set<std::string> names_, devices_;
    int stacks_ = 0, traced_ = 0;
};

} // namespace vkfv::measurement
