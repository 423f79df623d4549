// The real program as a subprocess, and configurations for it to read.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace vkfv::test {

struct ProgramResult {
    int exit_code = -1; // 128 + signal for a program that a signal ended
    std::string standard_output;
    std::string standard_error;
};

// The path of the program that tests start: with sanitizers, or its optimised twin where ctest says so (VKFV_PROGRAM).
std::string program();

// Runs program() with the arguments, in `folder`, with these environment variables besides its own.
ProgramResult run_program(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                          const std::map<std::string, std::string>& environment = {});

// An empty folder of this name below the running test's own temporary folder.
std::filesystem::path fresh_folder(const std::string& name);

void write_file(const std::filesystem::path& path, const std::string& content);
std::string read_file(const std::filesystem::path& path);

// A small configuration with every table; line numbers in tests refer to it.
extern const std::string small_configuration;

// A small configuration whose objective and tube lens are ideal, for tests in which lenses do not matter: tracing rays
// through them for the instrument's figures takes half the time of a stack of few rays.
std::string ideal_configuration();

// `text` with `from`, which it must hold, replaced by `to`.
std::string replaced(std::string text, const std::string& from, const std::string& to);

} // namespace vkfv::test
