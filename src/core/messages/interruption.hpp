// What a program says when it is told to end: what is kept, and what to type.
#pragma once

#include <string_view>

namespace vkfv {

// SIGINT, SIGTERM, SIGHUP and other signals that a user, a scheduler or a limit sends print the sentence at hand on
// standard error and then end the program as if nobody had caught them, so that a shell sees the signal (130, 143,
// 129). One that was ignored at the start stays ignored (nohup). SIGXFSZ is ignored.
void explain_interruptions();

// The sentence from now on; at most 500 bytes of it are said.
void say_when_interrupted(std::string_view sentence);

// From now on as a line of JSON: {"level":"error","signal":"SIGTERM","text":"..."}. Threads that say sentences start
// later.
void interruptions_as_json();

} // namespace vkfv
