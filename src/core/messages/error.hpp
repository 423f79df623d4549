// Typed errors of set-up. Physics never throws (it returns a status); main() catches these errors.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace vkfv {

// A place in the input. Lines and columns count from 1; 0 means "not known". Binary files have a byte offset instead.
struct SourceLocation {
    std::filesystem::path file;
    int line = 0;
    int column = 0;
    std::optional<std::uint64_t> byte_offset{};

    bool operator==(const SourceLocation&) const = default;

    // The place as "file:line:column" or "file@offset", as far as known.
    std::string to_string() const;
};

// An error in an input: every message names the place, the key or item, the value found, the value expected, and the
// remedy.
struct InputProblem {
    SourceLocation where;
    std::string key;      // "specimen.material.g", "triangle 17", "--rays"; may be empty
    std::string found;    // offending value as read
    std::string expected; // "a number in [-1, 1]"
    std::string remedy;   // one imperative sentence
};

// The user's input is wrong; exit code 2. The message has a line for each of the first ten problems, and the number of
// further ones.
class InputError : public std::runtime_error {
  public:
    explicit InputError(InputProblem problem);
    explicit InputError(std::vector<InputProblem> problems); // at least one, in the order of the message
    const InputProblem& problem() const { return problems_.front(); }
    const std::vector<InputProblem>& problems() const { return problems_; }

    // The error with every problem changed by `change(InputProblem&)`, for callers that know more about the problems.
    template <class Change>
    InputError with_each(Change change) const {
        auto problems = problems_;
        for (InputProblem& problem : problems) {
            change(problem);
        }
        return InputError(std::move(problems));
    }

  private:
    std::vector<InputProblem> problems_;
};

// Throws InputError for a file whose content, or which itself, is not as expected. `key` may be empty.
[[noreturn]] void refuse_file(const std::filesystem::path& file, std::string key, std::string found,
                              std::string expected, std::string remedy);

// No usable device; exit code 3. The message names the missing part and the remedy.
class DeviceError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

// The run failed and can be resumed; exit code 4.
class RunError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

} // namespace vkfv
