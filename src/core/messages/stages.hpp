// Where a program's time goes: the stages of its main thread, one after the other.
#pragma once

#include <string>
#include <string_view>

namespace vkfv {

// From now on. What goes on in other threads meanwhile is this stage's. A name that was there before goes on adding up.
// The main thread's alone.
void enter_stage(std::string_view name);

// A line a stage, in the order of their beginnings: seconds and share; the last is the sum, all of the time since the
// first call.
std::string stage_table();

} // namespace vkfv
