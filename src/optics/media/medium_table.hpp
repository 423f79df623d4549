// Media as TOML describes them: the tables [media.NAME] of prescriptions and of assets/glasses.
#pragma once

#include "core/toml/toml_reader.hpp"
#include "optics/media/medium.hpp"

#include <string>

namespace vkfv::optics {

inline constexpr NumberRange index_range = {.minimum = 1, .maximum = 5};
inline constexpr NumberRange abbe_range = {.minimum = 5, .maximum = 150}; // wider than the range of real glasses

// Reads the medium of a table, which has one of these forms: wavelengths_um and indices; nd and vd; index; formula,
// coefficients and range_um. `default_source` serves a table without `source`. Throws InputError, unless the document
// collects problems.
Medium read_medium(const TomlTable& table, const std::string& name, const std::string& default_source);

} // namespace vkfv::optics
