// The one exception that this library throws.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace vkfv {

// What is wrong in an input. Texts may be empty where nothing is known.
struct ErrorProblem {
    std::string place;       // "file:line:column"
    std::string key;         // "specimen.material.g"
    std::string found;       // the offending value as read
    std::string expectation; // "a number in [-1, 1]"
    std::string remedy;      // an imperative sentence
};

// The message, what(), has the words that the command vkfv prints.
class Error : public std::runtime_error {
  public:
    enum class Cause {
        input,  // a configuration or an argument is wrong
        device, // there is no usable device
        run     // the work failed; the same call may succeed when the message's remedy is taken
    };

    Error(Cause cause, const std::string& message, std::vector<ErrorProblem> problems = {});
    ~Error() override;
    Error(const Error&);
    Error& operator=(const Error&);

    Cause cause() const { return cause_; }
    const std::vector<ErrorProblem>& problems() const { return problems_; } // only of an input; else empty

  private:
    Cause cause_;
    std::vector<ErrorProblem> problems_;
};

} // namespace vkfv
