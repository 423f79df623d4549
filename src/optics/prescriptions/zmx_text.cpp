#include "optics/prescriptions/zmx_text.hpp"

#include "core/messages/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace vkfv::optics::zmx {

namespace {

constexpr std::size_t longest_quotation = 60; // characters of a line that a message quotes

constexpr std::string_view white_space = " \t\f\v\r";

std::vector<std::string> words_of(std::string_view text) {
    std::vector<std::string> words;
    for (std::size_t begin = text.find_first_not_of(white_space); begin != std::string_view::npos;) {
        const std::size_t end = std::min(text.find_first_of(white_space, begin), text.size());
        words.emplace_back(text.substr(begin, end - begin));
        begin = text.find_first_not_of(white_space, end);
    }
    return words;
}

} // namespace

Line line_of(std::string_view text, int number) {
    Line line{.number = number, .indented = text.starts_with(' ') || text.starts_with('\t')};
    line.rest = trimmed(text);
    const std::size_t end = line.rest.find_first_of(white_space);
    line.keyword = line.rest.substr(0, end);
    line.rest = end == std::string::npos ? "" : trimmed(std::string_view(line.rest).substr(end));
    line.words = words_of(line.rest);
    return line;
}

std::string trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(white_space);
    if (first == std::string_view::npos) {
        return {};
    }
    return std::string(text.substr(first, text.find_last_not_of(white_space) - first + 1));
}

std::optional<double> as_number(std::string_view word) {
    if (word.starts_with('+')) {
        word.remove_prefix(1);
    }
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) {
        return std::nullopt;
    }
    return value + 0.0; // + 0.0 avoids a negative zero
}

void refuse(const Place& place, const Line& line, std::string found, std::string expected, std::string remedy) {
    if (found.size() > longest_quotation) {
        found = found.substr(0, longest_quotation) + "...";
    }
    const std::string surface = place.surface ? fmt::format("surface {}: ", *place.surface) : "";
    throw InputError({.where = {.file = place.file, .line = line.number},
                      .key = surface + line.keyword.substr(0, longest_quotation),
                      .found = std::move(found),
                      .expected = std::move(expected),
                      .remedy = std::move(remedy)});
}

double number_at(const Place& place, const Line& line, std::size_t word, const NumberRange& range) {
    const auto value = word < line.words.size() ? as_number(line.words[word]) : std::nullopt;
    if (!value || !range.contains(*value)) {
        refuse(place, line, line.rest,
               trimmed(fmt::format("as value {} a finite number {}", word + 1, range.to_string())),
               "Correct the number; decimals take a point.");
    }
    return *value;
}

int integer_at(const Place& place, const Line& line, std::size_t word, int minimum, int maximum) {
    const double value = number_at(place, line, word);
    if (!(value >= minimum && value <= maximum && value == std::trunc(value))) {
        refuse(place, line, line.rest, fmt::format("as value {} an integer in [{}, {}]", word + 1, minimum, maximum),
               "Correct the number.");
    }
    return static_cast<int>(value);
}

} // namespace vkfv::optics::zmx
