// Numbers and units as a reader writes them: "1.234", "1.3 × 10⁷", "µm³/µm²".
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace vkfv::report {

// At most four significant digits; of a value whose standard uncertainty is known ("0.512 ± 0.013") the digits that
// this leaves, with two of its own. "–" for what is not finite.
std::string reader_number(double value);
std::string reader_number(double value, double uncertainty);
// All digits, in groups of three.
std::string reader_count(std::int64_t count);

// "um" becomes "µm", "um3_per_um2" "µm³/µm²", "deg" "°", "percent" "%"; others stay.
std::string reader_unit(std::string_view unit);

// A key of results.json as a label: "z_step_um" becomes "z step / µm".
std::string reader_label(std::string_view key);

} // namespace vkfv::report
