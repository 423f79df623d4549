// Text within SVG and HTML.
#pragma once

#include <string>
#include <string_view>

namespace vkfv::report {

// As the content of an element, or of an attribute between double quotes; control characters become spaces, new lines
// stay.
std::string escaped(std::string_view text);

} // namespace vkfv::report
