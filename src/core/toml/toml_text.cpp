#include "core/messages/safe_text.hpp"
#include "core/toml/toml_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vkfv {

bool NumberRange::contains(double value) const {
    return std::isfinite(value) && (minimum_included ? value >= minimum : value > minimum) &&
           (maximum_included ? value <= maximum : value < maximum);
}

std::string NumberRange::to_string() const {
    const bool below = std::isfinite(maximum);
    const bool above = std::isfinite(minimum);
    if (above && below) {
        return fmt::format("in {}{}, {}{}", minimum_included ? '[' : '(', minimum, maximum,
                           maximum_included ? ']' : ')');
    }
    if (above) {
        return fmt::format("{} {}", minimum_included ? ">=" : ">", minimum);
    }
    return below ? fmt::format("{} {}", maximum_included ? "<=" : "<", maximum) : "";
}

std::string shortest_toml(double value) {
    std::string text = fmt::format("{}", value);
    return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

bool is_length_in_um(std::string_view key) {
    const std::string_view name = key.substr(0, key.find('['));
    return name.ends_with("_um") && !name.ends_with("_per_um");
}

std::optional<std::string> expected_length(std::string_view key, double value) {
    const bool in_um = is_length_in_um(key);
    if ((!in_um && !key.substr(0, key.find('[')).ends_with("_mm")) || value == 0) {
        return std::nullopt;
    }
    const double shortest = in_um ? 1e-6 : 1e-9, longest = in_um ? 1e12 : 1e9;
    const double length = std::abs(value);
    if (length >= shortest && length <= longest) {
        return std::nullopt;
    }
    return fmt::format("a length that can be, 0 or from {:g} (1 pm) to {:g} {} (1000 km)", shortest, longest,
                       in_um ? "um" : "mm");
}

std::optional<std::string> remedy_for_length_um(double value, const NumberRange& range) {
    constexpr double um_per_nm = 1e-3;
    if (!(value > range.maximum && range.contains(value * um_per_nm))) {
        return std::nullopt;
    }
    return fmt::format("{:.12g} looks like nanometres: write {:.12g}.", value, value * um_per_nm);
}

std::string toml_quoted(std::string_view text) {
    std::string quoted = "\"";
    while (!text.empty()) {
        const Utf8Character character = first_character(text);
        const std::size_t bytes = std::max<std::size_t>(character.bytes, 1);
        if (character.bytes == 0) {
            quoted += "\\uFFFD"; // TOML is UTF-8, and has no form for other bytes
        } else if (is_unsafe_character(character.code)) {
            quoted += fmt::format("\\u{:04X}", character.code);
        } else {
            if (text.front() == '"' || text.front() == '\\') {
                quoted += '\\';
            }
            quoted += text.substr(0, bytes);
        }
        text.remove_prefix(bytes);
    }
    return quoted + '"';
}

std::optional<std::string> nearest_word(std::string_view word, const std::vector<std::string>& candidates,
                                        std::size_t most_steps) {
    // The optimal string alignment distance: insertions, deletions, substitutions and swaps of neighbours cost one.
    const auto distance = [&](std::string_view other) {
        std::vector<std::size_t> before(other.size() + 1), above(other.size() + 1), row(other.size() + 1);
        for (std::size_t j = 0; j <= other.size(); ++j) {
            above[j] = j;
        }
        for (std::size_t i = 1; i <= word.size(); ++i) {
            row[0] = i;
            for (std::size_t j = 1; j <= other.size(); ++j) {
                row[j] =
                    std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (word[i - 1] == other[j - 1] ? 0u : 1u)});
                if (i > 1 && j > 1 && word[i - 1] == other[j - 2] && word[i - 2] == other[j - 1]) {
                    row[j] = std::min(row[j], before[j - 2] + 1);
                }
            }
            before.swap(above);
            above.swap(row);
        }
        return above[other.size()];
    };
    const std::size_t furthest = std::min(most_steps, std::max<std::size_t>(2, word.size() / 2));
    std::optional<std::string> nearest;
    std::size_t smallest = furthest + 1;
    for (const auto& candidate : candidates) {
        const std::size_t steps = distance(candidate);
        // Words that differ by as many steps as they have letters have nothing in common.
        if (steps < smallest && steps < std::max(word.size(), candidate.size())) {
            smallest = steps;
            nearest = candidate;
        }
    }
    return nearest;
}

} // namespace vkfv
