// The light's field of a configuration, as the instrument takes it.
#pragma once

#include "configuration/configuration.hpp"
#include "optics/train/train.hpp"

#include <optional>

namespace vkfv::measurement {

// None where the configuration has none. Throws InputError (keys of [illumination.field]) as make_reflectance_map does.
std::optional<optics::LightField> make_light_field(const Configuration& configuration);

} // namespace vkfv::measurement
