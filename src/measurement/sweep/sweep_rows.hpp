// The rows of a sweep, each measured or taken over from an earlier run.
#pragma once

#include "configuration/configuration.hpp"
#include "core/files/result_folder.hpp"
#include "core/messages/progress.hpp"
#include "measurement/stack/stack.hpp"
#include "measurement/sweep/sweep_report.hpp"
#include "specimen/specimen.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace vkfv::measurement {

// Most sweeps do not vary the surface, and making it may take longer than tracing an image: so the last one is kept.
class Surfaces {
  public:
    struct Surface {
        specimen::Specimen specimen; // with the material asked for
        std::string digest;          // of the geometry
    };
    const Surface& of(const Configuration& configuration);

  private:
    std::optional<specimen::Description> made_of_;
    Surface surface_;
};

// An image and its figures, under a name in the results, from an earlier run if they are there and whole.
SweepRow image_row(const Configuration& configuration, ResultFolder& results, const std::filesystem::path& name,
                   Surfaces& surfaces);

// Repeated stacks of one combination: configurations with seeds of the trace that follow each other. How far their
// heights agree with each other, and their mean figures. after_stack gets each when it is measured.
SweepRow stack_row(const std::vector<Configuration>& repeats, Progress& progress,
                   const std::function<void(const StackResult&)>& after_stack);

} // namespace vkfv::measurement
