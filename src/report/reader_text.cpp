#include "report/reader_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace vkfv::report {

namespace {

constexpr int most_digits = 4;
constexpr int least_exponent = -4, most_exponent = 5; // written without a power of ten

constexpr std::array<std::pair<std::string_view, std::string_view>, 10> units = {{
    {"um3_per_um2", "µm³/µm²"},
    {"um", "µm"},
    {"mm", "mm"},
    {"deg", "°"},
    {"percent", "%"},
    {"W", "W"},
    {"e", "e⁻"},
    {"DN", "DN"},
    {"steps", "steps"},
    {"px", "px"},
}};

std::string superscript(int number) {
    constexpr std::array<const char*, 10> digits = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string text = number < 0 ? "⁻" : "";
    for (const char digit : fmt::format("{}", std::abs(number))) {
        text += digits[static_cast<std::size_t>(digit - '0')];
    }
    return text;
}

// With a minus of the width of a plus.
std::string fixed(double value, int decimals) {
    std::string text = fmt::format("{:.{}f}", std::abs(value), std::max(0, decimals));
    const bool zero = text.find_first_not_of("0.") == std::string::npos;
    return value < 0 && !zero ? "−" + text : text;
}

// Of the value rounded to so many digits.
int exponent_of(double value, int digits) {
    const auto text = fmt::format("{:.{}e}", value, digits - 1);
    return std::atoi(text.c_str() + text.find('e') + 1);
}

} // namespace

std::string reader_number(double value) {
    if (!std::isfinite(value)) {
        return "–";
    }
    if (value == 0) {
        return "0";
    }
    const int exponent = exponent_of(value, most_digits);
    const bool power = exponent < least_exponent || exponent > most_exponent;
    const double shown = power ? value / std::pow(10.0, exponent) : value;
    const int decimals = power ? most_digits - 1 : most_digits - 1 - exponent;
    if (decimals < 0) { // 123456: the last digits are not told
        const double unit = std::pow(10.0, -decimals);
        return fixed(std::round(shown / unit) * unit, 0);
    }
    std::string text = fixed(shown, decimals);
    if (text.find('.') != std::string::npos) { // 5.000 is a 5 that was set, or one of few digits
        text.erase(text.find_last_not_of('0') + 1);
        if (text.back() == '.') {
            text.pop_back();
        }
    }
    return power ? text + " × 10" + superscript(exponent) : text;
}

std::string reader_number(double value, double uncertainty) {
    if (!std::isfinite(value) || !(uncertainty > 0) || !std::isfinite(uncertainty)) {
        return reader_number(value);
    }
    constexpr int uncertain_digits = 2;
    const int own = value == 0 ? 0 : exponent_of(value, most_digits);
    const int decimals = std::min(uncertain_digits - 1 - exponent_of(uncertainty, uncertain_digits),
                                  value == 0 ? 12 : most_digits - 1 - own);
    if (own < least_exponent || own > most_exponent || decimals < 0 || decimals > 8) {
        return reader_number(value) + " ± " + reader_number(uncertainty);
    }
    const auto error = fixed(uncertainty, decimals);
    const bool vanishes = error.find_first_not_of("0.") == std::string::npos; // it is below the fourth digit
    return fixed(value, decimals) + " ± " + (vanishes ? fmt::format("{:.1g}", uncertainty) : error);
}

std::string reader_count(std::int64_t count) {
    std::string text = fmt::format("{}", std::abs(count));
    for (auto at = static_cast<std::ptrdiff_t>(text.size()) - 3; at > 0 && text.size() > 4; at -= 3) {
        text.insert(static_cast<std::size_t>(at), "\u202f"); // a narrow space that is not broken
    }
    return (count < 0 ? "−" : "") + text;
}

std::string reader_unit(std::string_view unit) {
    const auto found = std::ranges::find(units, unit, &std::pair<std::string_view, std::string_view>::first);
    return std::string(found == units.end() ? unit : found->second);
}

std::string reader_label(std::string_view key) {
    std::string unit;
    for (const auto& [name, written] : units) {
        if (key.size() > name.size() + 1 && key.ends_with(name) && key[key.size() - name.size() - 1] == '_') {
            unit = written;
            key.remove_suffix(name.size() + 1);
            break;
        }
    }
    std::string text(key);
    std::ranges::replace(text, '_', ' ');
    return unit.empty() ? text : text + " / " + unit;
}

} // namespace vkfv::report
