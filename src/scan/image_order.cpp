#include "scan/image_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

namespace vkfv::scan {

namespace {

bool is_digit(char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

// Takes the leading number off `text`; returns it without leading zeros, so that a longer one is larger.
std::string_view take_number(std::string_view& text) {
    const auto end = static_cast<std::size_t>(std::ranges::find_if_not(text, is_digit) - text.begin());
    std::string_view number = text.substr(0, end);
    number.remove_prefix(std::min(number.find_first_not_of('0'), number.size()));
    text.remove_prefix(end);
    return number;
}

// A name split into texts and the numbers between them.
struct Parts {
    std::vector<std::string> texts;   // one more than numbers
    std::vector<std::string> numbers; // "-5", "0.5", "007"
};

Parts parts_of(std::string_view name) {
    Parts parts{.texts = {""}, .numbers = {}};
    const auto digits_from = [name](std::size_t at) {
        std::size_t end = at;
        while (end < name.size() && is_digit(name[end])) {
            ++end;
        }
        return end;
    };
    for (std::size_t at = 0; at < name.size();) {
        const std::size_t first = name[at] == '-' || name[at] == '+' ? at + 1 : at;
        std::size_t end = digits_from(first);
        if (end == first) {
            parts.texts.back() += name[at++];
            continue;
        }
        if (end < name.size() && name[end] == '.' && digits_from(end + 1) > end + 1) {
            end = digits_from(end + 1);
        }
        parts.numbers.emplace_back(name.substr(at, end - at));
        parts.texts.emplace_back();
        at = end;
    }
    return parts;
}

// The digits after the decimal point.
std::string_view decimals(std::string_view number) {
    const auto point = number.find('.');
    return point == std::string_view::npos ? std::string_view() : number.substr(point + 1);
}

// The values of the one number in which the names differ, and the text after it.
struct Numbers {
    std::vector<double> values;
    std::string behind;
};

// Finds the number in which the names differ; none if they do not differ in exactly one number.
std::optional<Numbers> numbers_of(const std::vector<std::string>& names) {
    std::vector<Parts> all;
    std::ranges::transform(names, std::back_inserter(all), parts_of);
    std::optional<std::size_t> differs;
    for (const Parts& parts : all) {
        if (parts.texts != all.front().texts) {
            return std::nullopt;
        }
        for (std::size_t k = 0; k < parts.numbers.size(); ++k) {
            if (parts.numbers[k] != all.front().numbers[k]) {
                if (differs && *differs != k) {
                    return std::nullopt;
                }
                differs = k;
            }
        }
    }
    if (!differs) {
        return std::nullopt;
    }
    const auto text = [&](const Parts& parts) -> const std::string& { return parts.numbers[*differs]; };
    // Numbers such as 1.9, 1.10 are counts, as in versions; decimals have no zero at their end unless all have as many
    // digits.
    const bool even = std::ranges::all_of(
        all, [&](const Parts& parts) { return decimals(text(parts)).size() == decimals(text(all.front())).size(); });
    const bool counts =
        !even && std::ranges::any_of(all, [&](const Parts& parts) { return decimals(text(parts)).ends_with('0'); });
    constexpr std::size_t exact_digits = 15; // digits that a double holds exactly
    const bool separated = std::ranges::all_of(all, [&](const Parts& parts) { return text(parts).front() == '-'; });
    Numbers numbers{.values = {}, .behind = all.front().texts[*differs + 1]};
    for (const Parts& parts : all) {
        if (counts || text(parts).size() > exact_digits) {
            return std::nullopt;
        }
        const double value = std::stod(text(parts));
        numbers.values.push_back(separated ? -value : value);
    }
    return numbers;
}

// Length in mm of the unit at the beginning of a text, after a space or '_' or nothing; 0: there is no unit.
double unit_at(std::string_view text) {
    text.remove_prefix(!text.empty() && (text.front() == ' ' || text.front() == '_') ? 1 : 0);
    for (const auto& [unit, length] : std::initializer_list<std::pair<std::string_view, double>>{
             {"um", 1e-3}, {"\u00b5m", 1e-3}, {"\u03bcm", 1e-3}, {"nm", 1e-6}, {"mm", 1}}) {
        if (text.starts_with(unit) &&
            (text.size() == unit.size() || std::isalnum(static_cast<unsigned char>(text[unit.size()])) == 0)) {
            return length;
        }
    }
    return 0;
}

// The number of steps of each of the ascending values above the first; none if they have no common step. Tolerates
// rounded decimals.
std::optional<std::vector<int>> steps_of(const std::vector<double>& values, double& step) {
    std::vector<double> differences(values.size());
    std::adjacent_difference(values.begin(), values.end(), differences.begin());
    differences.erase(differences.begin());
    auto sorted = differences;
    std::ranges::sort(sorted);
    step = sorted[sorted.size() / 2]; // the most frequent step
    constexpr double tolerance = 0.1, most_steps = 1e6;
    std::vector<int> steps = {0};
    std::size_t single = 0;
    for (const double difference : differences) {
        const double multiple = std::round(difference / step);
        if (!(difference > 0) || multiple < 1 || multiple > most_steps - steps.back() ||
            std::abs(difference - multiple * step) > tolerance * step) {
            return std::nullopt;
        }
        single += multiple == 1 ? 1 : 0;
        steps.push_back(steps.back() + static_cast<int>(multiple));
    }
    if (static_cast<double>(single) < share_of_a_series * static_cast<double>(differences.size())) {
        return std::nullopt;
    }
    step = (values.back() - values.front()) / steps.back();
    return steps;
}

constexpr std::size_t least_of_a_series = 3;

// The indices of names that are alike except for their numbers, by the texts between these.
std::map<std::vector<std::string>, std::vector<std::size_t>> alike_names(const std::vector<std::string>& names) {
    std::map<std::vector<std::string>, std::vector<std::size_t>> alike;
    for (std::size_t k = 0; k < names.size(); ++k) {
        alike[parts_of(names[k]).texts].push_back(k);
    }
    return alike;
}

} // namespace

bool naturally_before(std::string_view a, std::string_view b) {
    const auto whole_a = a, whole_b = b;
    while (!a.empty() && !b.empty()) {
        if (is_digit(a.front()) && is_digit(b.front())) {
            const auto number_a = take_number(a), number_b = take_number(b);
            if (number_a.size() != number_b.size()) {
                return number_a.size() < number_b.size();
            }
            if (number_a != number_b) {
                return number_a < number_b;
            }
            continue;
        }
        if (a.front() != b.front()) {
            return a.front() < b.front();
        }
        a.remove_prefix(1);
        b.remove_prefix(1);
    }
    return a.empty() && b.empty() ? whole_a < whole_b : a.empty();
}

ImageOrder order_of_names(const std::vector<std::string>& names) {
    ImageOrder result;
    auto& order = result.order;
    order.resize(names.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return naturally_before(names[a], names[b]); });
    if (names.size() < 2) {
        result.heights.resize(names.size());
        return result;
    }
    result.heights.resize(names.size());
    std::iota(result.heights.begin(), result.heights.end(), 0);
    const auto numbers = numbers_of(names);
    if (!numbers) {
        result.doubt =
            fmt::format("their names do not differ in one number alone; they are taken in natural order, from {} "
                        "to {}",
                        names[order.front()], names[order.back()]);
        return result;
    }
    std::ranges::stable_sort(order, {}, [&](std::size_t k) { return numbers->values[k]; });
    std::vector<double> values;
    std::ranges::transform(order, std::back_inserter(values), [&](std::size_t k) { return numbers->values[k]; });
    double step = 0;
    const auto heights = steps_of(values, step);
    if (!heights) {
        const double first = values[1] - values[0];
        std::size_t k = 1;
        while (k + 1 < values.size() && std::abs(values[k] - values[k - 1] - first) <= 0.1 * first) {
            ++k;
        }
        result.doubt = fmt::format("the numbers in their names have no step in common: {} follows {}; equal steps are "
                                   "taken",
                                   names[order[k]], names[order[k - 1]]);
        return result;
    }
    result.heights = *heights;
    if (const double unit = unit_at(numbers->behind); unit > 0) {
        result.first = values.front() * unit;
        result.step = step * unit;
    }
    return result;
}

std::vector<bool> of_one_series(const std::vector<std::string>& names) {
    for (const auto& [texts, places] : alike_names(names)) {
        if (places.size() >= least_of_a_series &&
            static_cast<double>(places.size()) >= share_of_a_series * static_cast<double>(names.size())) {
            std::vector<std::string> of_series;
            std::vector<bool> result(names.size(), false);
            for (const std::size_t k : places) {
                of_series.push_back(names[k]);
                result[k] = true;
            }
            if (numbers_of(of_series)) {
                return result;
            }
        }
    }
    return std::vector<bool>(names.size(), true);
}

std::vector<std::size_t> several_series(const std::vector<std::string>& names) {
    std::vector<std::size_t> first;
    for (const auto& [texts, places] : alike_names(names)) {
        std::vector<std::string> of_series;
        for (const std::size_t k : places) {
            of_series.push_back(names[k]);
        }
        if (places.size() >= least_of_a_series && 3 * places.size() >= names.size() && numbers_of(of_series)) {
            first.push_back(places.front());
        }
    }
    return first.size() > 1 ? first : std::vector<std::size_t>();
}

} // namespace vkfv::scan
