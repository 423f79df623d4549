// The order of a stack's images, from the names of their files.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv::scan {

// True if a comes before b. Digits in a row count as one number, so that image_9 comes before image_10. Numbers of
// equal value and different length (9, 09) are ordered by their text, so that this is a strict order.
bool naturally_before(std::string_view a, std::string_view b);

// Files are a series if at least this share of them has the series' name, size or step. Other files are left out or
// named in a warning.
inline constexpr double share_of_a_series = 0.8;

struct ImageOrder {
    std::vector<std::size_t> order; // indices into `names`
    std::string doubt;              // reason why this may not be the order of the heights; empty: none
    // The heights of the images above the first one, in steps and in that order: 0, 1, 3, ... if the image of height 2
    // is missing.
    std::vector<int> heights;
    // Height of the first image and step, mm, if the names state the unit of their numbers.
    std::optional<double> first, step;
};

// The order of names (without their endings). Names that differ in exactly one number are ordered by it, and those that
// differ in several by the only one of these with a unit of length behind it. It may have decimals (z_0.5, z_0,5um) and
// signs (z-5, z+5); a '-' before all of them only separates, unless it follows '=' or a bracket, or a unit is behind
// the number and there is no other hyphen. If four of five steps between the numbers are equal and the others whole
// multiples of them, and no more images are missing than there are, heights follow the numbers; else equal steps are
// assumed, which is a doubt. Other names are in natural order, which is a doubt too.
ImageOrder order_of_names(const std::vector<std::string>& names);

// True for the names of one series: names that are alike except for their numbers and signs, if they are at least four
// of five and at least three, and differ in exactly one number. Otherwise true for all.
std::vector<bool> of_one_series(const std::vector<std::string>& names);

// The index of one name of each series in a folder that holds several (img_1 ... and aligned_img_1 ...): a series is at
// least three names and a third of all that are alike except for one number. Also series that a number in their names
// tells apart (scan1_001 ... and scan2_001 ...). Empty if there are not two series.
std::vector<std::size_t> several_series(const std::vector<std::string>& names);

} // namespace vkfv::scan
