#include "app/commands.hpp"
#include "command_line/completion.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace vkfv::app {

namespace {

void run_completion(const CommandOptions& options) {
    fmt::print("{}", completion_script(options.topic));
}

} // namespace

Command completion_command() {
    return {.name = "completion",
            .summary = "Print a script that completes commands, options and their values in a shell",
            .operands = {{"SHELL", "Which shell", &CommandOptions::topic, {"bash", "zsh", "fish"}}},
            .run = run_completion,
            .example = "source <(vkfv completion bash)",
            .about_vkfv = true,
            .also_option = false};
}

} // namespace vkfv::app
