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

// Measures an image and its figures under this name in the results, or takes them from an earlier run if they are there
// and whole. runs: lends its devices.
SweepRow image_row(const Configuration& configuration, ResultFolder& results, const std::filesystem::path& name,
                   Surfaces& surfaces, StackRuns& runs);

// The stacks of a sweep in the order of their measurement: those of a combination, whose trace seeds follow each other,
// then those of the next combination.
class SweptStacks {
  public:
    explicit SweptStacks(std::vector<std::vector<Configuration>> rows);
    SweptStacks(const SweptStacks&) = delete; // points into its own rows
    SweptStacks& operator=(const SweptStacks&) = delete;

    // A sentence that says what is traced: "Of 30 stacks the light of 1 is traced, 9 further are made of the same
    // light, and 20 of the same images".
    std::string plan() const;

    // Throws RunError where the files of the stacks that are not yet measured will not fit on the disk of this folder.
    void require_space(const std::filesystem::path& folder) const;

    // The number of images that are traced if none is there from an earlier run.
    double images() const;

    // Measures the stacks of the next combination. The row tells how far their heights agree with each other, and their
    // mean figures. after_stack gets each stack when it is measured.
    SweepRow measure_next(Progress& progress, const std::function<void(const StackResult&)>& after_stack);

  private:
    struct Keys {
        std::string images, light;
    };
    StackAmongOthers others_of(std::size_t stack) const;
    bool is_first_of_light(std::size_t stack) const;

    std::vector<std::vector<Configuration>> rows_;
    std::vector<const Configuration*> stacks_; // of all rows
    std::vector<Keys> keys_;
    std::size_t next_row_ = 0, next_stack_ = 0;
    StackRuns runs_;
};

} // namespace vkfv::measurement
