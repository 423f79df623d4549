// Typed errors of set-up. Physics never throws (it returns a status); main() catches these once.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace vkfv {

// Where in the input something stands. Lines and columns count from 1; 0 means "not known".
// Binary files give a byte offset instead.
struct SourceLocation {
    std::filesystem::path file;
    int line = 0;
    int column = 0;
    std::optional<std::uint64_t> byte_offset{};

    bool operator==(const SourceLocation&) const = default;

    // "file:line:column" or "file@offset", as far as known.
    std::string to_string() const;
};

// What is wrong with an input: every message names the place, the key or item, what was found,
// what was expected, and the remedy.
struct InputProblem {
    SourceLocation where;
    std::string key;      // "specimen.material.g", "triangle 17", "--rays"; may be empty
    std::string found;    // the offending value as read
    std::string expected; // "a number in [-1, 1]"
    std::string remedy;   // one imperative sentence
};

// Exit code 2: the user's input is wrong. The message has a line for each of the first ten problems, and tells how many
// more there are.
class InputError : public std::runtime_error {
  public:
    explicit InputError(InputProblem problem);
    explicit InputError(std::vector<InputProblem> problems); // at least one, in the order in which they are told
    const InputProblem& problem() const { return problems_.front(); }
    const std::vector<InputProblem>& problems() const { return problems_; }

    // The same error with every problem changed by `change(InputProblem&)`: for whoever knows more of them.
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

// Throws InputError: what stands in a file, or the file itself, is not what was expected. `key` may be empty.
[[noreturn]] void refuse_file(const std::filesystem::path& file, std::string key, std::string found,
                              std::string expected, std::string remedy);

// Exit code 3: no usable device. The message names what is missing and the remedy.
class DeviceError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

// Exit code 4: the run failed and can be resumed.
class RunError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

} // namespace vkfv
