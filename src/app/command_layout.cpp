#include "app/commands.hpp"
#include "measurement/assembly.hpp"

#include "core/file.hpp"
#include "report/layout.hpp"

namespace vkfv::app {

Command layout_command() {
    return {.name = "layout",
            .summary = "Draw the instrument to scale, with traced rays of illumination and imaging; needs no device",
            .operands = {{"C.toml", "Configuration", &CommandOptions::file},
                         {"OUT.svg", "The drawing", &CommandOptions::picture_file}},
            .options = configuration_options(),
            .run = run_layout,
            .example = "vkfv layout assets/stacks/demo.toml layout.svg"};
}

void run_layout(const CommandOptions& options) {
    const auto configuration = load_configuration(options.file, options.overrides, Needs::instrument);
    const auto instrument = measurement::assemble_instrument(configuration);
    write_file(options.picture_file, report::layout_svg(instrument, options.file.stem().string()));
}

} // namespace vkfv::app
