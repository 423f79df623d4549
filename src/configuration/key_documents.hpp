// Documents of the configuration's keys, which are written from the keys' declarations (core/keys/key.hpp).
#pragma once

#include "core/keys/key.hpp"

#include <string>
#include <vector>

namespace vkfv {

// All tables in the order of a configuration, with the root first.
const std::vector<const KeyTable*>& key_tables();

// Every key with its unit, values, default and meaning: for a terminal, as JSON, and as the page docs/configuration.md.
std::string keys_text();
std::string keys_json();
std::string keys_markdown();

// The text of one key ("source.radius_mm") or one table ("source") for a terminal. Throws InputError, with the most
// likely name, if the name is unknown.
std::string explained(const std::string& key);

// A configuration with every key, which can be traced as it is. Required keys have an example, all others stand as
// comments with their default.
std::string configuration_template();

// A JSON Schema (draft-07) of configurations, for the completion of editors.
std::string configuration_schema();

} // namespace vkfv
