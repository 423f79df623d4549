#include "app/commands.hpp"
#include "command_line/completion.hpp"
#include "core/messages/safe_text.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace vkfv::app {

namespace {

struct CompletionOptions {
    std::string shell;
};

void run_completion(const CommandOptions& options) {
    print_text(completion_script(options.of<CompletionOptions>().shell));
}

} // namespace

Command completion_command() {
    return {.name = "completion",
            .summary = "Print a script that completes commands, options and their values in a shell",
            .operands = {{"SHELL", "Which shell", into(&CompletionOptions::shell), {"bash", "zsh", "fish"}}},
            .run = run_completion,
            .example = "source <(vkfv completion bash)",
            .about_vkfv = true,
            .also_option = false};
}

} // namespace vkfv::app
