#include "app/commands.hpp"
#include "measurement/assembly.hpp"

#include "core/file.hpp"
#include "report/layout.hpp"

namespace vkfv::app {

void run_layout(const CommandOptions& options) {
    const auto configuration = load_configuration(options.file, options.overrides, Needs::instrument);
    const auto instrument = measurement::assemble_instrument(configuration);
    write_file(options.picture_file, report::layout_svg(instrument, options.file.stem().string()));
}

} // namespace vkfv::app
