#include "app/commands.hpp"

#include "core/error.hpp"
#include "report/layout.hpp"

#include <fmt/format.h>

#include <fstream>

namespace vkfv::app {

void run_layout(const CommandOptions& options) {
    const auto configuration = load_configuration(options.file, options.overrides, Needs::instrument);
    const auto instrument = assemble_instrument(configuration);
    const std::string text = report::layout_svg(instrument, options.file.stem().string());
    std::ofstream stream(options.picture_file, std::ios::binary);
    stream << text;
    stream.close();
    if (!stream) {
        throw RunError(fmt::format("{} cannot be written. Check the path, its permissions and the free space, and run "
                                   "the same command again.",
                                   options.picture_file.string()));
    }
}

} // namespace vkfv::app
