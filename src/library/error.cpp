#include "vkfv/error.hpp"

#include <utility>

namespace vkfv {

Error::Error(Cause cause, const std::string& message, std::vector<ErrorProblem> problems)
    : std::runtime_error(message), cause_(cause), problems_(std::move(problems)) {}
Error::~Error() = default;
Error::Error(const Error&) = default;
Error& Error::operator=(const Error&) = default;

} // namespace vkfv
