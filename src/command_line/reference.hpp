// What is told of the commands, all of it from their declarations.
#pragma once

#include "command_line/command.hpp"

#include <string>
#include <vector>

namespace vkfv::command_line {

// An option of several commands is declared by each of them, by the same means: here it is once.
struct OwnedOption {
    const Option* option; // as its first owner declares it
    std::vector<const Command*> owners;
};
const std::vector<OwnedOption>& all_options();

// "--z_step_um" of an option with two spellings.
std::string first_name(const Option& option);
// "--z_step_um UM"; "--json".
std::string term_of(const Option& option);

// For a terminal: a few lines for who types `vkfv` alone.
std::string usage_text();
// For a terminal; null: of the whole program.
std::string help_text(const Command* command);
// The whole reference, as Markdown (docs/commands.md) and in roff, for man.
std::string reference_markdown();
std::string reference_manual();

} // namespace vkfv::command_line
