#include "scan/image_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>
#include <optional>

namespace vkfv::scan {

namespace {

bool is_digit(char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

// Takes the number that `text` begins with off it; without leading zeros, so that the longer is the larger.
std::string_view take_number(std::string_view& text) {
    const auto end = static_cast<std::size_t>(std::ranges::find_if_not(text, is_digit) - text.begin());
    std::string_view number = text.substr(0, end);
    number.remove_prefix(std::min(number.find_first_not_of('0'), number.size()));
    text.remove_prefix(end);
    return number;
}

// A name as texts and the numbers between them.
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

// What stands behind the point.
std::string_view decimals(std::string_view number) {
    const auto point = number.find('.');
    return point == std::string_view::npos ? std::string_view() : number.substr(point + 1);
}

// The values of the one number in which the names differ; none if they differ otherwise.
std::optional<std::vector<double>> values_of(const std::vector<std::string>& names) {
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
    // 1.9, 1.10 count, as versions do; decimals have no zero at their end unless all have as many.
    const bool even = std::ranges::all_of(
        all, [&](const Parts& parts) { return decimals(text(parts)).size() == decimals(text(all.front())).size(); });
    const bool counts =
        !even && std::ranges::any_of(all, [&](const Parts& parts) { return decimals(text(parts)).ends_with('0'); });
    constexpr std::size_t exact_digits = 15; // of a double
    const bool separated = std::ranges::all_of(all, [&](const Parts& parts) { return text(parts).front() == '-'; });
    std::vector<double> values;
    for (const Parts& parts : all) {
        if (counts || text(parts).size() > exact_digits) {
            return std::nullopt;
        }
        const double value = std::stod(text(parts));
        values.push_back(separated ? -value : value);
    }
    return values;
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
        return result;
    }
    const auto values = values_of(names);
    if (!values) {
        result.doubt =
            fmt::format("their names do not differ in one number alone; they are taken in natural order, from {} "
                        "to {}",
                        names[order.front()], names[order.back()]);
        return result;
    }
    std::ranges::stable_sort(order, {}, [&](std::size_t k) { return (*values)[k]; });
    const double step = (*values)[order[1]] - (*values)[order[0]];
    for (std::size_t k = 1; k < order.size(); ++k) {
        const double here = (*values)[order[k]] - (*values)[order[k - 1]];
        // Decimals are rounded ones.
        if (!(here > 0 && std::abs(here - step) <= 0.1 * step)) {
            result.doubt = fmt::format("the numbers in their names are not equidistant: {} follows {}", names[order[k]],
                                       names[order[k - 1]]);
            break;
        }
    }
    return result;
}

} // namespace vkfv::scan
