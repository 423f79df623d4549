// The rows of a sweep, each measured or taken over from an earlier run.
#pragma once

#include "configuration/configuration.hpp"
#include "core/files/result_folder.hpp"
#include "core/messages/progress.hpp"
#include "measurement/scene/surfaces.hpp"
#include "measurement/stack/stack_runs.hpp"
#include "measurement/sweep/sweep_report.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace vkfv::measurement {

// An image and its figures, under a name in the results, from an earlier run if they are there and whole. runs: its
// devices are used.
SweepRow image_row(const Configuration& configuration, ResultFolder& results, const std::filesystem::path& name,
                   Surfaces& surfaces, StackRuns& runs);

// The stacks of a sweep in the order of their measurement: those of a combination, whose seeds of the trace follow each
// other, then those of the next.
class SweptStacks {
  public:
    explicit SweptStacks(std::vector<std::vector<Configuration>> rows);
    SweptStacks(const SweptStacks&) = delete; // it points into its own rows
    SweptStacks& operator=(const SweptStacks&) = delete;

    // A sentence on what is traced for all stacks: "Of 30 stacks the light of 1 is traced, 9 further are made of the
    // same light, and 20 of the same images".
    std::string plan() const;

    // The stacks of the next combination: how far their heights agree with each other, and their mean figures.
    // after_stack gets each when it is measured.
    SweepRow measure_next(Progress& progress, const std::function<void(const StackResult&)>& after_stack);

  private:
    struct Keys {
        std::string images, light;
    };
    StackAmongOthers others_of(std::size_t stack) const;

    std::vector<std::vector<Configuration>> rows_;
    std::vector<const Configuration*> stacks_; // of all rows
    std::vector<Keys> keys_;
    std::size_t next_row_ = 0, next_stack_ = 0;
    StackRuns runs_;
};

} // namespace vkfv::measurement
