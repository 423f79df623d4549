// Completion in shells: scripts that need nothing but themselves, so that a key pressed starts no program.
#pragma once

#include <string>

namespace vkfv::command_line {

// shell: "bash", "zsh" or "fish".
std::string completion_script(const std::string& shell);

} // namespace vkfv::command_line
