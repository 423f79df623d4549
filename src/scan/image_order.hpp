// The order of a stack's images, from the names of their files.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv::scan {

// Digits in a row count as one number, so that image_9 comes before image_10. Numbers of equal value in different
// lengths (9, 09) are told apart by their text, so that this is a strict order.
bool naturally_before(std::string_view a, std::string_view b);

// Files are a series if at least this share of them has the series' name, size or step. The others are left out or
// named in a warning.
inline constexpr double share_of_a_series = 0.8;

struct ImageOrder {
    std::vector<std::size_t> order; // places in `names`
    std::string doubt;              // why this may not be the order of the heights; empty: none
    // The heights of the images above the first of them, in steps and in that order: 0, 1, 3, ... where the image of
    // height 2 is missing.
    std::vector<int> heights;
    // Where the names say of which unit of length their numbers are: mm.
    std::optional<double> first, step;
};

// Names (without their endings) that differ in one number alone are in the order of that number, which may have
// decimals (z_0.5) and signs (z-5, z+5; a '-' before all of them only separates). Where four of five steps between the
// numbers are equal and the others whole multiples of them, heights follow the numbers; else equal steps are taken,
// which is a doubt. Other names are in natural order, which is a doubt too.
ImageOrder order_of_names(const std::vector<std::string>& names);

// Which names are of one series: those that are alike but for their numbers and signs, if that is four of five at
// least, three in all, and they differ in one number alone. Else all.
std::vector<bool> of_one_series(const std::vector<std::string>& names);

// The place of a name of each series, where a folder holds several (img_1 ... and aligned_img_1 ...): names that are
// alike but for one number, at least three of them and a third of all. Empty: there are no two.
std::vector<std::size_t> several_series(const std::vector<std::string>& names);

} // namespace vkfv::scan
