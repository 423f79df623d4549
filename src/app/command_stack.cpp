#include "app/commands.hpp"
#include "core/progress.hpp"
#include "measurement/stack.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace vkfv::app {

void run_stack(const CommandOptions& options) {
    auto progress = Progress::on_standard_error(options.quiet);
    const auto configuration = load_configuration(options.file, options.overrides, Needs::stack);
    fmt::print("{}", measurement::summary(measurement::measure_stack(configuration, progress)));
}

} // namespace vkfv::app
