#include "app/commands.hpp"
#include "core/messages/progress.hpp"
#include "core/messages/safe_text.hpp"
#include "measurement/sweep/sweep.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace vkfv::app {

Command sweep_command() {
    return {.name = "sweep",
            .summary = "Images or stacks for every combination of the parameters in [sweep]; continues an interrupted "
                       "one",
            .operands = {{"C.toml", "Configuration", into(&CommandOptions::file)}},
            .options = together({configuration_options(), {out_option("Output folder"), json_option()}}),
            .run = run_sweep,
            .example = "vkfv sweep assets/stacks/paper_logo_small.toml"};
}

void run_sweep(const CommandOptions& options) {
    auto progress = Progress::on_standard_error(options.quiet);
    const auto result =
        measurement::run_sweep(options.file, options.overrides, progress, [&](const measurement::StackResult& stack) {
            if (!options.json) {
                print_text(measurement::summary(stack));
            }
        });
    if (options.json) {
        print_text(measurement::sweep_json(result.sweep, result.rows));
    } else {
        print_text(fmt::format("{}results in {}\n", measurement::sweep_markdown(result.sweep, result.rows),
                               safe_line(result.folder.string())));
    }
    tell_results(result.folder);
}

} // namespace vkfv::app
