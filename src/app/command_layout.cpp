#include "app/commands.hpp"
#include "measurement/scene/assembly.hpp"

#include "core/files/file.hpp"
#include "report/layout.hpp"

namespace vkfv::app {

namespace {

struct LayoutOptions {
    std::filesystem::path picture;
};

} // namespace

Command layout_command() {
    return {.name = "layout",
            .summary = "Draw the instrument to scale, with traced rays of illumination and imaging; needs no device",
            .operands = {{"C.toml", "Configuration", into(&CommandOptions::file)},
                         {"OUT.svg", "The drawing", into(&LayoutOptions::picture)}},
            .options = configuration_options(),
            .run = run_layout,
            .example = "vkfv layout assets/stacks/demo.toml layout.svg"};
}

void run_layout(const CommandOptions& options) {
    const auto configuration = load_configuration(options.file, options.overrides, Needs::instrument);
    const auto instrument = measurement::assemble_instrument(configuration);
    write_file(options.of<LayoutOptions>().picture, report::layout_svg(instrument, options.file.stem().string()));
}

} // namespace vkfv::app
