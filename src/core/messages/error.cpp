#include "core/messages/error.hpp"

#include "core/messages/safe_text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace vkfv {

std::string SourceLocation::to_string() const {
    std::string text = safe_line(file.string());
    if (byte_offset) {
        return fmt::format("{}@{}", text, *byte_offset);
    }
    if (line > 0) {
        text += fmt::format(":{}", line);
        if (column > 0) {
            text += fmt::format(":{}", column);
        }
    }
    return text;
}

namespace {

constexpr std::size_t most_told = 10; // problems in a message, about a screen

std::string describe(const InputProblem& problem) {
    std::string text = problem.where.to_string();
    if (!text.empty()) {
        text += ": ";
    }
    if (!problem.key.empty()) {
        text += safe_line(problem.key);
        text += problem.found.empty() ? ": " : " = " + safe_line(problem.found) + ": ";
    } else if (!problem.found.empty()) {
        text += safe_line(problem.found) + ": ";
    }
    text += "expected " + problem.expected;
    if (!problem.remedy.empty()) {
        text += ". " + problem.remedy;
    }
    return text;
}

std::string describe(const std::vector<InputProblem>& problems) {
    std::string text;
    for (std::size_t i = 0; i < std::min(problems.size(), most_told); ++i) {
        text += (i > 0 ? "\n" : "") + describe(problems[i]);
    }
    if (problems.size() > most_told) {
        text += fmt::format("\nand {} more", problems.size() - most_told);
    }
    return text;
}

} // namespace

InputError::InputError(InputProblem problem) : InputError(std::vector{std::move(problem)}) {}

InputError::InputError(std::vector<InputProblem> problems)
    : std::runtime_error(describe(problems)), problems_(std::move(problems)) {}

void refuse_file(const std::filesystem::path& file, std::string key, std::string found, std::string expected,
                 std::string remedy) {
    throw InputError({.where = {.file = file},
                      .key = std::move(key),
                      .found = std::move(found),
                      .expected = std::move(expected),
                      .remedy = std::move(remedy)});
}

} // namespace vkfv
