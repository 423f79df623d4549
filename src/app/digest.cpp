#include "app/digest.hpp"

#include <fmt/format.h>

namespace vkfv::app {

std::string Digest::text() const {
    return fmt::format("{:016x}", state_);
}

} // namespace vkfv::app
