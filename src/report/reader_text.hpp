// Numbers and units as a reader writes them: "1.234", "1.3 × 10⁷", "µm³/µm²".
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv::report {

// A number that was set, with at most four significant digits: "5". "–" if it is not finite.
std::string reader_number(double value);
// A number that was measured, with four significant digits: "5.000".
std::string reader_figure(double value);
// A value with its standard uncertainty if this is known: two digits of the uncertainty, and the value to the same
// decimals, "0.512 ± 0.013". If these would be more than six digits, each is written by itself.
std::string reader_number(double value, double uncertainty);

// The common notation of numbers that are compared.
struct NumberForm {
    int decimals = 0;
    int power = 0; // power of ten after the number
};
// The notation with the decimals that the largest value has at four significant digits.
NumberForm form_for(const std::vector<double>& values);
// The notation with the decimals of a value that has this standard uncertainty.
NumberForm form_for(double value, double uncertainty);
std::string reader_number(double value, const NumberForm& form);
// A nominal value, the measured one, and their deviation, all with the decimals of the largest of the three, which is
// the deviation if their signs differ.
std::vector<std::string> reader_deviation(double nominal, double measured);
// The values in a common notation, unless the smallest would keep fewer than two digits: then each as a figure.
std::vector<std::string> reader_column(const std::vector<double>& values);
// A count with all digits, in groups of three.
std::string reader_count(std::int64_t count);

// The unit for readers: "um" becomes "µm", "um3_per_um2" "µm³/µm²", "deg" "°", "percent" "%"; others stay.
std::string reader_unit(std::string_view unit);

// Values that were set, numbers or texts, in a common notation: powers of ten if one of them needs it.
std::vector<std::string> reader_values(const std::vector<std::string>& values);

// A key of results.json as a label: "z_step_um" becomes "z step / µm".
std::string reader_label(std::string_view key);

} // namespace vkfv::report
