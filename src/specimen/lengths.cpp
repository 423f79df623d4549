#include "specimen/lengths.hpp"

#include <fmt/format.h>

namespace vkfv::specimen {

std::string positive_um() {
    return fmt::format("a length from {:.6g} to {:.6g} um", smallest_length * um_per_mm, largest_length * um_per_mm);
}

void require(bool condition, const SourceLocation& where, const std::string& key, double found,
             const std::string& expected) {
    if (!condition) {
        throw InputError(
            {where, "specimen." + key, fmt::format("{}", found), expected, "Correct the value in the configuration."});
    }
}

void require_um(bool condition, const SourceLocation& where, const std::string& key, double mm,
                const std::string& expected) {
    require(condition, where, key, mm * um_per_mm, expected);
}

} // namespace vkfv::specimen
