// The time that a program spends in the stages of its main thread, which follow one another.
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <utility>

namespace vkfv {

// Enters a stage. Work of other threads meanwhile belongs to it too. A name used before continues to accumulate. Calls
// of threads other than the first caller's have no effect.
void enter_stage(std::string_view name);

// The current stage and the time at which it was entered, for any thread. The name is empty before the first stage.
std::pair<std::string, std::chrono::steady_clock::time_point> stage_now();

// A table with a line for each stage, in the order of first entry: seconds and share; the last line is the sum, the
// whole time since the first call.
std::string stage_table();

} // namespace vkfv
