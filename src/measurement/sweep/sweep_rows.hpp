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

    // The number of stacks that are best measured at once: one where the processor traces, several where a GPU would
    // wait while heights are evaluated and files are written. All of them fit into the GPU's memory.
    int lanes() const;

    // A listener follows the measurement by calls that never overlap. With several lanes they come from other threads,
    // and in any order of the rows.
    struct Listener {
        std::function<void(std::size_t row)> begins;                          // before the row's first stack
        std::function<void(std::size_t row, const StackResult&)> after_stack; // when a stack is measured
        // The row tells how far the heights of its stacks agree with each other, and their mean figures.
        std::function<void(std::size_t row, SweepRow&&)> after_row;
    };
    // Measures all stacks, as many at once as there are lanes; those of the same light one after the other. Files have
    // the same bytes however many lanes there are. The first exception, also of a listener, ends the measurement when
    // the stacks under way are done, and is rethrown. With several lanes `progress` is not used, as it tells of one
    // stack.
    void measure(Progress& progress, int lanes, const Listener& listener) const;

  private:
    struct Keys {
        std::string images, light;
    };
    StackAmongOthers others_of(std::size_t stack) const;
    bool is_first_of_light(std::size_t stack) const;
    std::vector<std::vector<std::size_t>> rows_by_light() const;
    SweepRow measure_row(std::size_t row, StackRuns& runs, Progress& progress,
                         const std::function<void(const StackResult&)>& after_stack) const;

    std::vector<std::vector<Configuration>> rows_;
    std::vector<std::size_t> first_stacks_;    // of the rows
    std::vector<const Configuration*> stacks_; // of all rows
    std::vector<Keys> keys_;
};

} // namespace vkfv::measurement
