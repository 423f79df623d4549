// Text within SVG and HTML.
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

namespace vkfv::report {

// As the content of an element, or of an attribute between double quotes; control characters become spaces, new lines
// stay.
std::string escaped(std::string_view text);

// As the content of a script element: no markup can begin in it. What is not finite becomes null.
std::string json_text(const nlohmann::ordered_json& json);

} // namespace vkfv::report
