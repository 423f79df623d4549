// What the program was called with.
#pragma once

namespace vkfv::command_line {

// Runs the command that the arguments name, as `vkfv stack C.toml` or `vkfv --stack C.toml`, or prints help or the
// version. False: there are no arguments, and a short usage went to standard error. Throws InputError, also of
// arguments that do not parse, and whatever the command throws.
bool run_command_line(int argument_count, char** argument_values);

} // namespace vkfv::command_line
