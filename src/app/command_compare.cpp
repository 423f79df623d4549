#include "app/commands.hpp"
#include "measurement/comparison_report.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace vkfv::app {

void run_compare(const CommandOptions& options) {
    const auto& files = options.compared_files;
    const measurement::ComparisonRequest request{.measurements = {files.begin(), files.end() - 1},
                                                 .truth = files.back(),
                                                 .align = options.align,
                                                 .band = options.band};
    const auto result = measurement::compare_files(request);
    if (options.out) {
        measurement::write_comparison(*options.out, request, result);
    }
    fmt::print("{}", options.json ? measurement::comparison_json(request, result).dump(2) + "\n"
                                  : measurement::comparison_text(request, result));
}

} // namespace vkfv::app
