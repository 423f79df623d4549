#include "core/error.hpp"

#include <fmt/format.h>

namespace vkfv {

std::string SourceLocation::to_string() const {
    std::string text = file.string();
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

std::string describe(const InputProblem& problem) {
    std::string text = problem.where.to_string();
    if (!text.empty()) {
        text += ": ";
    }
    if (!problem.key.empty()) {
        text += problem.key;
        text += problem.found.empty() ? ": " : " = " + problem.found + ": ";
    } else if (!problem.found.empty()) {
        text += problem.found + ": ";
    }
    text += "expected " + problem.expected;
    if (!problem.remedy.empty()) {
        text += ". " + problem.remedy;
    }
    return text;
}

} // namespace

InputError::InputError(InputProblem problem)
    : std::runtime_error(describe(problem)), problem_(std::move(problem)) {}

} // namespace vkfv
