// Numbers and units as a reader writes them: "1.234", "1.3 × 10⁷", "µm³/µm²".
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv::report {

// At most four significant digits, for what was set: "5". "–" for what is not finite.
std::string reader_number(double value);
// Four significant digits, for what was measured: "5.000".
std::string reader_figure(double value);
// With its standard uncertainty, where that is known: two digits of it, and those of the value that it leaves,
// "0.512 ± 0.013". Where it would leave more than six, either has its own.
std::string reader_number(double value, double uncertainty);

// How numbers that are compared are written alike.
struct NumberForm {
    int decimals = 0;
    int power = 0; // of ten, behind them
};
// With the decimals that the largest has at four significant digits.
NumberForm form_for(const std::vector<double>& values);
// With the decimals of a value that has this standard uncertainty.
NumberForm form_for(double value, double uncertainty);
std::string reader_number(double value, const NumberForm& form);
// A nominal value, the measured one, and their deviation; all alike, in the decimals of the largest of the three, which
// is the deviation where their signs differ.
std::vector<std::string> reader_deviation(double nominal, double measured);
// Alike, unless the least would keep fewer than two digits: then each as a figure.
std::vector<std::string> reader_column(const std::vector<double>& values);
// All digits, in groups of three.
std::string reader_count(std::int64_t count);

// "um" becomes "µm", "um3_per_um2" "µm³/µm²", "deg" "°", "percent" "%"; others stay.
std::string reader_unit(std::string_view unit);

// Values that were set, as doubles or texts, all in one notation: powers of ten where one of them needs it.
std::vector<std::string> reader_values(const std::vector<std::string>& values);

// A key of results.json as a label: "z_step_um" becomes "z step / µm".
std::string reader_label(std::string_view key);

} // namespace vkfv::report
