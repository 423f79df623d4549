// Names of the values of an enumeration, in its order.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv::topography {

// The index of the name among the names. Throws InputError with this key and remedy if it is none of them.
std::size_t place_of_name(std::string_view name, const std::vector<std::string>& names, const char* key,
                          const char* remedy);

} // namespace vkfv::topography
