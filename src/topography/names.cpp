#include "topography/names.hpp"

#include "core/messages/error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace vkfv::topography {

std::size_t place_of_name(std::string_view name, const std::vector<std::string>& names, const char* key,
                          const char* remedy) {
    const auto found = std::ranges::find(names, name);
    if (found == names.end())
        throw InputError({.where = {},
                          .key = key,
                          .found = std::string(name),
                          .expected = fmt::format("\"{}\"", fmt::join(names, "\", \"")),
                          .remedy = remedy});
    return static_cast<std::size_t>(found - names.begin());
}

} // namespace vkfv::topography
