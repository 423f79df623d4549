// The order of a stack's images, from the names of their files.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv::scan {

// Digits in a row count as one number, so that image_9 comes before image_10. Numbers of equal value in different
// lengths (9, 09) are told apart by their text, so that this is a strict order.
bool naturally_before(std::string_view a, std::string_view b);

struct ImageOrder {
    std::vector<std::size_t> order; // places in `names`
    std::string doubt;              // why this may not be the order of the heights; empty: none
};

// Names (without their endings) that differ in one number alone are in the order of that number, which may have
// decimals (z_0.5) and signs (z-5, z+5; a '-' before all of them only separates); a number that is missing is a doubt.
// Others are in natural order, which is a doubt.
ImageOrder order_of_names(const std::vector<std::string>& names);

} // namespace vkfv::scan
