// Usage, help and reference of the commands, all made from their declarations.
#pragma once

#include "command_line/command.hpp"

#include <string>
#include <vector>

namespace vkfv::command_line {

// An option with the commands that take it. Each of them declares an option of several commands by the same function;
// here it stands once.
struct OwnedOption {
    const Option* option; // as the first owner declares it
    std::vector<const Command*> owners;
};
const std::vector<OwnedOption>& all_options();

// The first spelling of an option with two: "--z_step_um".
std::string first_name(const Option& option);
// The option with its value, as "--z_step_um UM" or "--json".
std::string term_of(const Option& option);

// A usage of a few lines, for a person who types `vkfv` alone.
std::string usage_text();
// The help for a terminal: of a command, or with null of the whole program.
std::string help_text(const Command* command);
// The whole reference: Markdown for docs/commands.md, and roff for man.
std::string reference_markdown();
std::string reference_manual();

} // namespace vkfv::command_line
