// Scripts for completion in shells. The scripts need no other program, so that pressing a key starts none.
#pragma once

#include <string>

namespace vkfv::command_line {

// The script for a shell: "bash", "zsh" or "fish".
std::string completion_script(const std::string& shell);

} // namespace vkfv::command_line
