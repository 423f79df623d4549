// Escapes text for SVG and HTML.
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

namespace vkfv::report {

// Text for the content of an element or an attribute in double quotes; control characters become spaces, new lines
// stay.
std::string escaped(std::string_view text);

// JSON for the content of a script element, in which no markup can begin. Numbers that are not finite become null.
std::string page_json(const nlohmann::ordered_json& json);

} // namespace vkfv::report
