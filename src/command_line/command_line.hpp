// The command line of the program.
#pragma once

namespace vkfv::command_line {

// Runs the command that the arguments name, as `vkfv stack C.toml` or `vkfv --stack C.toml`, or prints help or the
// version. Returns false if there are no arguments; then a short usage went to standard error. Throws InputError, also
// for arguments that do not parse, and whatever the command throws.
bool run_command_line(int argument_count, char** argument_values);

} // namespace vkfv::command_line
