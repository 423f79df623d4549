// The light's field of a configuration, in the form that the instrument takes.
#pragma once

#include "configuration/configuration.hpp"
#include "optics/train/train.hpp"

#include <optional>

namespace vkfv::measurement {

// The configured field of the light; none where the configuration has none. Throws InputError as make_reflectance_map()
// does, with keys of [illumination.field].
std::optional<optics::LightField> make_light_field(const Configuration& configuration);

} // namespace vkfv::measurement
