#include "report/reader_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <optional>
#include <utility>

namespace vkfv::report {

namespace {

constexpr int most_digits = 4;
constexpr int uncertain_digits = 2;
constexpr int least_exponent = -4, most_exponent = 5; // range that is written without a power of ten

constexpr std::array<std::pair<std::string_view, std::string_view>, 12> units = {{
    {"um3_per_um2", "µm³/µm²"},
    {"per_mm2", "1/mm²"},
    {"per_mm", "1/mm"},
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

// The number with a minus as wide as a plus. Negative decimals: the last digits before the point are zeros.
std::string fixed(double value, int decimals) {
    const double unit = decimals < 0 ? std::pow(10.0, -decimals) : 1;
    const double shown = decimals < 0 ? std::round(value / unit) * unit : value;
    std::string text = fmt::format("{:.{}f}", std::abs(shown), std::max(0, decimals));
    const bool zero = text.find_first_not_of("0.") == std::string::npos;
    return value < 0 && !zero ? "−" + text : text;
}

// The decimal exponent of the value rounded to so many digits.
int exponent_of(double value, int digits) {
    const auto text = fmt::format("{:.{}e}", value, digits - 1);
    return std::atoi(text.c_str() + text.find('e') + 1);
}

int power_of(int exponent) {
    return exponent < least_exponent || exponent > most_exponent ? exponent : 0;
}

std::string times(int power) {
    return power == 0 ? "" : " × 10" + superscript(power);
}

std::string without_last_zeros(std::string text) {
    if (text.find('.') != std::string::npos) {
        text.erase(text.find_last_not_of('0') + 1);
        if (text.back() == '.') {
            text.pop_back();
        }
    }
    return text;
}

std::string digits_of(double value, const NumberForm& form) {
    return fixed(value / std::pow(10.0, form.power), form.decimals);
}

std::string figure(double value, int digits) {
    const int exponent = exponent_of(value, digits);
    const int power = power_of(exponent);
    return reader_number(value, NumberForm{.decimals = digits - 1 - exponent + power, .power = power});
}

std::optional<double> value_of(const std::string& text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

} // namespace

std::string reader_number(double value) {
    if (!std::isfinite(value)) {
        return "–";
    }
    const auto form = form_for({value});
    return value == 0 ? "0" : without_last_zeros(digits_of(value, form)) + times(form.power);
}

std::string reader_figure(double value) {
    return value == 0 ? "0" : reader_number(value, form_for({value}));
}

std::string reader_number(double value, double uncertainty) {
    constexpr int most_certain_digits = 6;
    if (!std::isfinite(value) || !(uncertainty > 0) || !std::isfinite(uncertainty)) {
        return reader_figure(value);
    }
    const int last = exponent_of(uncertainty, uncertain_digits) - (uncertain_digits - 1);
    if (value != 0 && exponent_of(value, most_digits) - last >= most_certain_digits) {
        return reader_figure(value) + " ± " + figure(uncertainty, uncertain_digits);
    }
    const auto form = form_for(value, uncertainty);
    const auto both = digits_of(value, form) + " ± " + digits_of(uncertainty, form);
    return form.power == 0 ? both : "(" + both + ")" + times(form.power);
}

NumberForm form_for(const std::vector<double>& values) {
    double largest = 0;
    for (const double value : values) {
        largest = std::isfinite(value) ? std::max(largest, std::abs(value)) : largest;
    }
    const int exponent = exponent_of(largest, most_digits);
    const int power = power_of(exponent);
    return {.decimals = most_digits - 1 - exponent + power, .power = power};
}

NumberForm form_for(double value, double uncertainty) {
    const int power = power_of(exponent_of(std::max(std::abs(value), uncertainty), most_digits));
    return {.decimals = power - exponent_of(uncertainty, uncertain_digits) + uncertain_digits - 1, .power = power};
}

std::string reader_number(double value, const NumberForm& form) {
    return std::isfinite(value) ? digits_of(value, form) + times(form.power) : "–";
}

std::vector<std::string> reader_deviation(double nominal, double measured) {
    const std::vector values{nominal, measured, measured - nominal};
    std::vector<std::string> texts;
    std::ranges::transform(values, std::back_inserter(texts),
                           [form = form_for(values)](double value) { return reader_number(value, form); });
    return texts;
}

std::vector<std::string> reader_column(const std::vector<double>& values) {
    const auto form = form_for(values);
    const double two_digits = 10 * std::pow(10.0, form.power - form.decimals);
    const bool alike = std::ranges::none_of(
        values, [&](double value) { return value != 0 && std::isfinite(value) && std::abs(value) < two_digits; });
    std::vector<std::string> texts;
    std::ranges::transform(values, std::back_inserter(texts),
                           [&](double value) { return alike ? reader_number(value, form) : reader_figure(value); });
    return texts;
}

std::vector<std::string> reader_values(const std::vector<std::string>& values) {
    const bool powers = std::ranges::any_of(values, [](const std::string& text) {
        const auto value = value_of(text);
        return value && *value != 0 && power_of(exponent_of(*value, most_digits)) != 0;
    });
    std::vector<std::string> texts;
    for (const std::string& text : values) {
        const auto value = value_of(text);
        if (!value || (powers && *value == 0)) {
            texts.push_back(text);
            continue;
        }
        const double size = std::abs(*value);
        const int exponent = powers ? exponent_of(size, 15) : 0;
        const auto digits = fmt::format("{:.15g}", size / std::pow(10.0, exponent));
        const std::string sign = *value < 0 ? "−" : "";
        texts.push_back(sign + (!powers         ? digits
                                : digits == "1" ? "10" + superscript(exponent)
                                                : digits + " × 10" + superscript(exponent)));
    }
    return texts;
}

std::string reader_count(std::int64_t count) {
    std::string text = fmt::format("{}", std::abs(count));
    for (auto at = static_cast<std::ptrdiff_t>(text.size()) - 3; at > 0 && text.size() > 4; at -= 3) {
        text.insert(static_cast<std::size_t>(at), "\u202f"); // a narrow no-break space
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
