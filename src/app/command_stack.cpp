#include "app/commands.hpp"
#include "core/progress.hpp"
#include "measurement/stack.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace vkfv::app {

Command stack_command() {
    return {.name = "stack",
            .summary =
                "Trace a focus stack, reconstruct it and compare it with the truth; continues an interrupted one",
            .operands = {{"C.toml", "Configuration", into(&CommandOptions::file)}},
            .options = together({configuration_options(), {out_option("Output folder")}}),
            .run = run_stack,
            .example = "vkfv stack assets/stacks/demo.toml --out demo"};
}

void run_stack(const CommandOptions& options) {
    auto progress = Progress::on_standard_error(options.quiet);
    const auto configuration = load_configuration(options.file, options.overrides, Needs::stack);
    fmt::print("{}", measurement::summary(measurement::measure_stack(configuration, progress)));
}

} // namespace vkfv::app
