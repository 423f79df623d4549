// Keys that kinds of specimens from a file share.
#pragma once

#include "core/keys/section.hpp"

namespace vkfv::specimen {

// `file`, which must be given.
FileKey needed_file_key(std::string meaning);

// `unit`, whose value is mm per unit of the file; without a fallback there is none, unless the key says more.
ChoiceKey<double> unit_key(std::optional<double> fallback, std::string meaning);

} // namespace vkfv::specimen
