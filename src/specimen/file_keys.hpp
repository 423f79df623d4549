// Keys shared by the kinds of specimens that are read from a file.
#pragma once

#include "core/keys/section.hpp"

namespace vkfv::specimen {

// The required key `file`.
FileKey needed_file_key(std::string meaning);

// The key `unit`, whose value is mm per unit of the file. Without a fallback it has no default, unless the key's text
// states one.
ChoiceKey<double> unit_key(std::optional<double> fallback, std::string meaning);

} // namespace vkfv::specimen
