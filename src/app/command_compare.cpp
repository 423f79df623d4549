#include "app/commands.hpp"
#include "core/messages/json_text.hpp"
#include "core/messages/safe_text.hpp"
#include "measurement/surface/comparison_report.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace vkfv::app {

namespace {

struct CompareOptions {
    std::vector<std::filesystem::path> files; // measurements, then the truth
    bool align = false;                       // remove the lateral shift
};

} // namespace

Command compare_command() {
    const Option align = {.name = "--align",
                          .value = "",
                          .description = "Remove the lateral shift that was found",
                          .target = into(&CompareOptions::align)};
    return {.name = "compare",
            .summary = "Height maps (any format that vkfv reads) against the truth: shift, deviation, transfer, ISO "
                       "25178-2 parameters; several measurements of one field also give systematic and random part",
            .operands = {{"MEASURED... TRUTH", "Height maps, the last of them true", into(&CompareOptions::files)}},
            .options = together({{out_option("Folder for tables, maps and pictures"), json_option()},
                                 band_options(),
                                 {align, accept_checksum_option()}}),
            .run = run_compare,
            .example = "vkfv compare measured.x3p truth.tif --out compared"};
}

void run_compare(const CommandOptions& options) {
    const auto own = options.of<CompareOptions>();
    const auto& files = own.files;
    const measurement::ComparisonRequest request{.measurements = {files.begin(), files.end() - 1},
                                                 .truth = files.back(),
                                                 .align = own.align,
                                                 .accept_checksum = options.of<AcceptChecksum>().value,
                                                 .band = options.of<surface::Band>()};
    const auto result = measurement::compare_files(request);
    if (options.out) {
        measurement::write_comparison(*options.out, request, result);
    }
    print_text(options.json ? json_text(measurement::comparison_json(request, result)) + "\n"
                            : measurement::comparison_text(request, result));
}

} // namespace vkfv::app
