// Numbers that a configuration has as it is read, by their dotted keys.
#pragma once

#include "configuration/configuration.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace vkfv::measurement {

// The number of a dotted key in the key's unit, defaults included; none: the configuration has no such number.
std::optional<double> number_in(const Configuration& configuration, const std::string& key);

// Those of the keys that the configuration has, with their values.
std::map<std::string, std::uint32_t> seeds_in(const Configuration& configuration, const std::vector<std::string>& keys);

} // namespace vkfv::measurement
