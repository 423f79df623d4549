#include "app/commands.hpp"
#include "measurement/comparison_report.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace vkfv::app {

Command compare_command() {
    const Option align = {.name = "--align",
                          .value = "",
                          .description = "Remove the lateral shift that was found",
                          .target = &CommandOptions::align};
    return {.name = "compare",
            .summary = "Height maps (any format that vkfv reads) against the truth: shift, deviation, transfer, ISO "
                       "25178-2 parameters; several measurements of one field also give systematic and random part",
            .operands = {{"MEASURED... TRUTH", "Height maps, the last of them true", &CommandOptions::compared_files}},
            .options = together(
                {{out_option("Folder for tables, maps and pictures"), json_option()}, band_options(), {align}}),
            .run = run_compare,
            .example = "vkfv compare measured.x3p truth.tif --out compared"};
}

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
