// The documents of a capability map.
#pragma once

#include "measurement/capability/capability.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace vkfv::measurement {

nlohmann::ordered_json capability_json(const Capability& capability);

// The map as an SVG: the sinusoids, the limits that cross them, and the specimen.
std::string capability_map(const Capability& capability);

// capability.html: the map with the limits, the specimen, and the table of the nodes.
std::string capability_page(const Capability& capability);

// Sentences: what limits the configuration's specimen and which instrument would measure it, and what the limits in
// closed form do not tell.
std::vector<std::string> remarks_of(const Capability& capability);

} // namespace vkfv::measurement
