#include "app/commands.hpp"
#include "command_line/reference.hpp"
#include "core/messages/safe_text.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace vkfv::app {

namespace {

struct HelpOptions {
    std::string command;
};

void run_help(const CommandOptions& options) {
    const auto own = options.of<HelpOptions>();
    if (options.markdown) {
        print_text(reference_markdown());
        return;
    }
    print_text(help_text(own.command.empty() ? nullptr : &command_named(own.command)));
}

void run_man(const CommandOptions&) {
    print_text(reference_manual());
}

} // namespace

Command help_command() {
    return {.name = "help",
            .summary = "What the program does, or what a command takes",
            .operands = {{"COMMAND", "Its name", into(&HelpOptions::command), {}, false}},
            .options = {markdown_option()},
            .run = run_help,
            .example = "vkfv help stack",
            .about_vkfv = true,
            .also_option = false};
}

Command man_command() {
    return {.name = "man",
            .summary = "Print the manual page, in roff",
            .run = run_man,
            .example = "vkfv man | man -l -",
            .about_vkfv = true,
            .also_option = false};
}

} // namespace vkfv::app
