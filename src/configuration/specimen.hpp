// Internal to the reading of the configuration: the specimen.
#pragma once

#include "configuration/configuration.hpp"

namespace vkfv {

// [specimen] with its roughness and material. Throws InputError.
void read_specimen(const TomlTable& root, Configuration& configuration);

} // namespace vkfv
