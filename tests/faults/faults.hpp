// Runs the real program with one of its calls failing.
#pragma once

#include "app/program.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace vkfv::test {

struct Fault {
    std::string call;
    int number = 0; // of the calls of this name, from 1
    std::string effect;
    bool lasts = false;    // and those of the name that follow it
    std::string subject{}; // the file that the call concerned, as far as it concerned one
};

std::string text_of(const Fault& fault);

// The calls that the libraries of tests/faults/injected counted, in the order of the log; their effects are for the
// caller to choose.
std::vector<Fault> counted_calls(const std::filesystem::path& log);

// Whether VKFV_EVERY_FAULT is in the environment: every effect is tried, instead of those that a CI machine has time
// for.
bool every_fault();

using Environment = std::map<std::string, std::string>;
using Files = std::map<std::string, std::string>;

// Adds the settings of a run in which this call fails.
void add(Environment& environment, const Fault& fault);

// The bytes of all files below a folder by their names, besides those that hold times and locks.
Files files_below(const std::filesystem::path& folder);

// Names of files that differ, or that only one has.
std::vector<std::string> differing(const Files& some, const Files& others);

} // namespace vkfv::test
