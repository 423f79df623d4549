// The documents of the configuration's keys are written from the keys' declarations (core/keys/key.hpp).
#pragma once

#include "core/keys/key.hpp"

#include <string>
#include <vector>

namespace vkfv {

// All tables, in the order of a configuration; the root first.
const std::vector<const KeyTable*>& key_tables();

// Every key with its unit, what it may be, its default and its sentence: for a terminal, as JSON, and as the page
// docs/configuration.md.
std::string keys_text();
std::string keys_json();
std::string keys_markdown();

// The same of one key ("source.radius_mm") or of one table ("source"). Throws InputError if the name is unknown, and
// names what was most likely meant.
std::string explained(const std::string& key);

// A configuration with every key: those that must be given with an example, all others as comments with their default.
// It can be traced as it is.
std::string configuration_template();

// A JSON Schema (draft-07) of configurations, for the completion of editors.
std::string configuration_schema();

} // namespace vkfv
