// The range of lengths for specimens, and the refusal of invalid values.
#pragma once

#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"

#include <string>

namespace vkfv::specimen {

// The range of lengths in mm, from 0.1 pm to a kilometre: others are no specimen of a microscope, and their squares
// exceed the range of a device's floats.
inline constexpr double smallest_length = 1e-10, largest_length = 1e6;

// True for a length in this range; false for NaN.
constexpr bool positive(double mm) {
    return mm >= smallest_length && mm <= largest_length;
}
// The condition of positive() in words, for messages.
std::string positive_um();

// Throws InputError for a key of [specimen] ("radius_um") unless the condition holds. where: place of the table.
void require(bool condition, const SourceLocation& where, const std::string& key, double found,
             const std::string& expected);
// Throws InputError like require(), for a length in mm under a key in um.
void require_um(bool condition, const SourceLocation& where, const std::string& key, double mm,
                const std::string& expected);

} // namespace vkfv::specimen
