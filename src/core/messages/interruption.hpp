// The last words of a program that a signal ends: the results that are kept, and the command to continue.
#pragma once

#include <string_view>

namespace vkfv {

// Installs handlers for SIGINT, SIGTERM, SIGHUP and other signals by which a user, a scheduler or a limit ends a
// program. They print the current sentence on standard error and then end the program by the same signal, so that a
// shell sees it (130, 143, 129). A signal that was ignored at the start stays ignored (nohup). SIGXFSZ is ignored.
// Signals of a fault, such as SIGSEGV, say that it is one.
void explain_interruptions();

// Sets the sentence; at most 500 bytes of it are printed.
void say_when_interrupted(std::string_view sentence);

// Prints the sentence as a line of JSON from now on: {"level":"error","signal":"SIGTERM","text":"..."}. It must be
// called before threads that set sentences start.
void interruptions_as_json();

} // namespace vkfv
