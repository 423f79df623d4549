#include "scan/image_order.hpp"

#include "core/parsing/length_unit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
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

// Length in mm of the unit at the beginning of a text, after a space or '_' or nothing; 0: there is no unit. Focal
// positions are stated in units from the angstrom to the millimetre: "10m" and "10pm" in a name are times.
double unit_at(std::string_view text) {
    constexpr double smallest = 1e-7, largest = 1;
    text.remove_prefix(!text.empty() && (text.front() == ' ' || text.front() == '_') ? 1 : 0);
    const auto behind = std::ranges::find_if(
        text, [](unsigned char c) { return c < 0x80 && std::isalnum(c) == 0; }); // bytes of UTF-8 belong to the word
    const double length = mm_per_length_unit(std::string_view(text.begin(), behind)).value_or(0);
    return length >= smallest && length <= largest ? length : 0;
}

// A name split into texts and the numbers between them.
struct Parts {
    std::vector<std::string> texts;   // one more than numbers
    std::vector<std::string> numbers; // "-5", "0.5", "007"
};

// The name with a hyphen for every minus sign of Unicode.
std::string with_hyphens(std::string_view name) {
    constexpr std::string_view minus = "\u2212";
    std::string result(name);
    for (std::size_t at = result.find(minus); at != std::string::npos; at = result.find(minus, at)) {
        result.replace(at, minus.size(), "-");
    }
    return result;
}

Parts parts_of(std::string_view given) {
    const std::string name = with_hyphens(given);
    Parts parts{.texts = {""}, .numbers = {}};
    const auto digits_from = [&name](std::size_t at) {
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
        const std::size_t comma = end;
        if (end < name.size() && (name[end] == '.' || name[end] == ',') && digits_from(end + 1) > end + 1) {
            const std::size_t decimals_end = digits_from(end + 1);
            // A comma separates decimals if a unit follows them, and numbers otherwise.
            if (name[end] == '.' || unit_at(std::string_view(name).substr(decimals_end)) > 0) {
                end = decimals_end;
            }
        }
        parts.numbers.emplace_back(name.substr(at, end - at));
        if (comma < end) {
            parts.numbers.back()[comma - at] = '.';
        }
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

// The places of the numbers in which these names, alike except for their numbers, differ.
std::vector<std::size_t> differing_numbers(const std::vector<Parts>& alike) {
    std::vector<std::size_t> differing;
    for (std::size_t k = 0; k < alike.front().numbers.size(); ++k) {
        if (std::ranges::any_of(alike,
                                [&](const Parts& parts) { return parts.numbers[k] != alike.front().numbers[k]; })) {
            differing.push_back(k);
        }
    }
    return differing;
}

// True if a '-' after this text and before a number is its sign, though all numbers have one: '=' and brackets separate
// already, and a length whose name has no other hyphen is a height.
bool is_sign_after(const Parts& parts, std::size_t number) {
    const std::string& before = parts.texts[number];
    const bool separated = !before.empty() && std::string_view("=([").find(before.back()) != std::string_view::npos;
    const bool other_hyphens =
        std::ranges::any_of(parts.texts, [](const std::string& text) { return text.find('-') != std::string::npos; });
    const auto hyphens = std::ranges::count_if(parts.numbers, [](const std::string& n) { return n.front() == '-'; });
    return separated || (unit_at(parts.texts[number + 1]) > 0 && hyphens == 1 && !other_hyphens);
}

// Finds the number in which the names differ or, if they differ in several, the only one of these with a unit behind
// it, as the height is beside a count (img_007_z-30um); none if there is no such number.
std::optional<Numbers> numbers_of(const std::vector<std::string>& names) {
    std::vector<Parts> all;
    std::ranges::transform(names, std::back_inserter(all), parts_of);
    if (std::ranges::any_of(all, [&](const Parts& parts) { return parts.texts != all.front().texts; })) {
        return std::nullopt;
    }
    std::vector<std::size_t> differing = differing_numbers(all);
    if (differing.size() > 1) {
        std::erase_if(differing, [&](std::size_t k) { return !(unit_at(all.front().texts[k + 1]) > 0); });
    }
    if (differing.size() != 1) {
        return std::nullopt;
    }
    const std::size_t differs = differing.front();
    const auto text = [&](const Parts& parts) -> const std::string& { return parts.numbers[differs]; };
    // Numbers such as 1.9, 1.10 are counts, as in versions; decimals have no zero at their end unless all have as many
    // digits.
    const bool even = std::ranges::all_of(
        all, [&](const Parts& parts) { return decimals(text(parts)).size() == decimals(text(all.front())).size(); });
    const bool counts =
        !even && std::ranges::any_of(all, [&](const Parts& parts) { return decimals(text(parts)).ends_with('0'); });
    constexpr std::size_t exact_digits = 15; // digits that a double holds exactly
    const bool separated = std::ranges::all_of(all, [&](const Parts& parts) { return text(parts).front() == '-'; }) &&
                           !is_sign_after(all.front(), differs);
    Numbers numbers{.values = {}, .behind = all.front().texts[differs + 1]};
    for (const Parts& parts : all) {
        if (counts || text(parts).size() > exact_digits) {
            return std::nullopt;
        }
        const double value = std::stod(text(parts));
        numbers.values.push_back(separated ? -value : value);
    }
    return numbers;
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
    // If far more images are missing than there are, the numbers are those of several series, or of a camera's counter
    // that began again. A folder with a gap misses about as many images as it has, a counter of four digits thousands:
    // the limit lies between, and is not derived.
    constexpr double most_missing = 10; // for each image that is there
    const auto present = static_cast<double>(values.size());
    if (static_cast<double>(single) < share_of_a_series * static_cast<double>(differences.size()) ||
        steps.back() + 1 - present > most_missing * present) {
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

namespace {

// The first of each series among these names, alike except for their numbers, where one number counts the images and
// the others the series (scan1_001, ..., scan2_001, ...): each series has three images or more, and two thirds of the
// counts of the shortest are found in the first. Empty if there are not two series. A count that goes on beside
// another number (a time after midnight) makes no series.
std::vector<std::size_t> series_by_numbers(const std::vector<std::string>& names,
                                           const std::vector<std::size_t>& places) {
    std::vector<Parts> alike;
    for (const std::size_t k : places) {
        alike.push_back(parts_of(names[k]));
    }
    std::vector<std::size_t> found; // as few series as possible
    for (const std::size_t counting : differing_numbers(alike)) {
        std::map<std::vector<std::string>, std::map<std::string, std::size_t>> series; // by the others; count, place
        for (std::size_t k = 0; k < alike.size(); ++k) {
            auto others = alike[k].numbers;
            const std::string count = std::exchange(others[counting], "");
            series[others].emplace(count, places[k]);
        }
        const auto& counts = series.begin()->second;
        const bool all_alike = std::ranges::all_of(series, [&](const auto& one) {
            const auto common =
                std::ranges::count_if(one.second, [&](const auto& entry) { return counts.contains(entry.first); });
            return one.second.size() >= least_of_a_series &&
                   3 * static_cast<std::size_t>(common) >= 2 * std::min(one.second.size(), counts.size());
        });
        if (series.size() > 1 && all_alike && (found.empty() || series.size() < found.size())) {
            found.clear();
            for (const auto& one : series) {
                found.push_back(one.second.begin()->second);
            }
        }
    }
    return found;
}

} // namespace

std::vector<std::size_t> several_series(const std::vector<std::string>& names) {
    std::vector<std::size_t> first;
    for (const auto& [texts, places] : alike_names(names)) {
        if (places.size() < least_of_a_series || 3 * places.size() < names.size()) {
            continue;
        }
        if (auto counted = series_by_numbers(names, places); !counted.empty()) {
            return counted;
        }
        std::vector<std::string> of_series;
        for (const std::size_t k : places) {
            of_series.push_back(names[k]);
        }
        if (numbers_of(of_series)) {
            first.push_back(places.front());
        }
    }
    return first.size() > 1 ? first : std::vector<std::size_t>();
}

} // namespace vkfv::scan
