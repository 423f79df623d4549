#include "app/commands.hpp"
#include "core/progress.hpp"
#include "measurement/sweep.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace vkfv::app {

void run_sweep(const CommandOptions& options) {
    auto progress = Progress::on_standard_error(options.quiet);
    const auto result =
        measurement::run_sweep(options.file, options.overrides, progress, [](const measurement::StackResult& stack) {
            fmt::print("{}", measurement::summary(stack));
        });
    fmt::print("{}results in {}\n", measurement::sweep_markdown(result.sweep, result.rows), result.folder.string());
}

} // namespace vkfv::app
