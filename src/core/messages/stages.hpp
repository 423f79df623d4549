// Where a program's time goes: the stages of its main thread, one after the other.
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <utility>

namespace vkfv {

// From now on. What goes on in other threads meanwhile is this stage's. A name that was there before goes on adding up.
// The main thread's alone.
void enter_stage(std::string_view name);

// The stage that was entered last, and when; for any thread. Before the first its name is empty.
std::pair<std::string, std::chrono::steady_clock::time_point> stage_now();

// A line a stage, in the order of their beginnings: seconds and share; the last is the sum, all of the time since the
// first call.
std::string stage_table();

} // namespace vkfv
