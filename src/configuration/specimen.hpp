// Internal to the reading of the configuration: the specimen.
#pragma once

#include "configuration/configuration.hpp"
#include "core/key.hpp"

namespace vkfv {

// [specimen], [specimen.roughness], [specimen.material] and [[specimen.material.lobe]]. A key of [specimen] that
// several kinds have is listed once for each declaration, a parameter of a scatter model once for each model.
const KeyTable& specimen_table();
const KeyTable& roughness_table();
const KeyTable& material_table();
const KeyTable& lobe_table();

// All of them. Throws InputError.
void read_specimen(const TomlTable& root, Configuration& configuration);

} // namespace vkfv
