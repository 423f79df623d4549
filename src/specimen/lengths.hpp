// Which lengths a specimen may have, and the refusal of values that do not fit.
#pragma once

#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"

#include <string>

namespace vkfv::specimen {

// What is shorter or longer, mm, is no specimen of a microscope, and its squares leave the numbers of a device: 0.1 pm,
// a kilometre.
inline constexpr double smallest_length = 1e-10, largest_length = 1e6;

// Within them; never NaN.
constexpr bool positive(double mm) {
    return mm >= smallest_length && mm <= largest_length;
}
// The same in words.
std::string positive_um();

// Throws InputError for the key of [specimen] ("radius_um") where the condition does not hold. where: of the table.
void require(bool condition, const SourceLocation& where, const std::string& key, double found,
             const std::string& expected);
// The same of a length in mm under a key in um.
void require_um(bool condition, const SourceLocation& where, const std::string& key, double mm,
                const std::string& expected);

} // namespace vkfv::specimen
