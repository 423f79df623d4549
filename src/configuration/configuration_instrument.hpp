// The part of the configuration that says what the instrument is.
#pragma once

#include "configuration/configuration.hpp"

namespace vkfv {

// glass_catalogs, for all that names a glass; first. Throws InputError, as does the next.
void read_glass_catalogs(const TomlTable& root, Configuration& configuration);

// [source] to [detector].
void read_instrument(const TomlTable& root, Configuration& configuration);

} // namespace vkfv
