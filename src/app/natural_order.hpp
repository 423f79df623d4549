// The order in which people read names: digits in a row count as one number, so that image_9 comes before image_10.
#pragma once

#include <string_view>

namespace vkfv::app {

// Numbers of equal value in different lengths (9, 09) are told apart by their text, so that this is a strict order.
bool naturally_before(std::string_view a, std::string_view b);

} // namespace vkfv::app
