#include "app/commands.hpp"
#include "measurement/instrument_figures.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace vkfv::app {

Command check_command() {
    return {.name = "check",
            .summary = "Validate and print first-order data; needs no device",
            .operands = {{"C.toml", "Configuration", into(&CommandOptions::file)}},
            .options = together({configuration_options(), {json_option()}}),
            .run = run_check,
            .example = "vkfv check assets/stacks/demo.toml --json"};
}

void run_check(const CommandOptions& options) {
    const auto figures =
        measurement::instrument_figures(load_configuration(options.file, options.overrides, Needs::instrument));
    fmt::print("{}", options.json ? measurement::instrument_json(figures, options.file).dump(2) + "\n"
                                  : measurement::instrument_text(figures, options.file));
}

} // namespace vkfv::app
