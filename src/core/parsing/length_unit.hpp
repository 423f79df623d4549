// Names of units of length, as programs and instruments write them into their files.
#pragma once

#include <optional>
#include <string_view>

namespace vkfv {

// Size of a unit in mm by its symbol ("um", the micro sign and the angstrom in their encodings) or its name, also in
// the plural, with a capital ("Microns") or in capitals ("MM"); none for another word. Symbols with a capital behind or
// before small letters are no units here: "Mm" and "Nm" are no millimetre and no nanometre.
std::optional<double> mm_per_length_unit(std::string_view name);

} // namespace vkfv
