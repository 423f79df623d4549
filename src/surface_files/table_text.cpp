#include "surface_files/table_text.hpp"

#include "core/parsing/byte_reader.hpp"
#include "surface_files/provenance.hpp"
#include "surface_files/table_header.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace vkfv::surface {
namespace {

// The notation of numbers in a line.
struct Style {
    char separator = ' '; // a blank: any number of blanks and tabs
    bool decimal_comma = false;
};

std::optional<double> number_of(std::string_view cell, const Style& style) {
    if (!style.decimal_comma)
        return number_in<double>(cell);
    std::string text(cell);
    std::ranges::replace(text, ',', '.');
    return number_in<double>(text);
}

// The notation of a line of numbers without its quoted parts. A semicolon or a tab is always the separator, and commas
// are then decimal ones unless the line has points. With blanks, commas are decimal ones if a digit directly follows
// each of them.
Style style_outside_quotes(std::string_view line) {
    line = bare(line);
    const bool comma = line.find(',') != std::string_view::npos;
    for (const char separator : {';', '\t'})
        if (line.find(separator) != std::string_view::npos)
            return {separator, comma && line.find('.') == std::string_view::npos};
    if (!comma)
        return {' ', false};
    if (line.find(' ') == std::string_view::npos || line.find('.') != std::string_view::npos)
        return {',', false};
    for (auto at = line.find(','); at != std::string_view::npos; at = line.find(',', at + 1))
        if (at + 1 >= line.size() || line[at + 1] < '0' || line[at + 1] > '9')
            return {',', false};
    return {' ', true};
}

// The notation of a line; a comma between quotes is a decimal comma.
Style style_of(std::string_view line) {
    if (line.find('"') == std::string_view::npos)
        return style_outside_quotes(line);
    std::string outside, inside;
    bool quoted = false;
    for (const char c : line) {
        quoted = quoted != (c == '"');
        if (c != '"')
            (quoted ? inside : outside) += c;
    }
    Style style = style_outside_quotes(outside);
    style.decimal_comma = inside.find(',') != std::string::npos && inside.find('.') == std::string::npos;
    return style;
}

bool is_data(std::string_view line, const Style& style) {
    bool first = true, numbers = false, words = false;
    for (const std::string_view cell : cells_of(line, style.separator)) {
        const bool number = number_of(cell, style).has_value();
        // A line of data may begin with a gap, which is not a heading's word.
        const bool gap = cell.empty() || cell == "NaN" || cell == "nan" || cell == "NAN" || cell == "BAD" ||
                         cell == "Bad" || cell.find_first_not_of("*-") == std::string_view::npos;
        words = words || (first && !number && !gap);
        numbers = numbers || number || !cell.empty();
        first = false;
    }
    return numbers && !words;
}

} // namespace

std::string_view bare(std::string_view text) {
    const auto begin = text.find_first_not_of(" \t\r");
    return begin == std::string_view::npos ? std::string_view()
                                           : text.substr(begin, text.find_last_not_of(" \t\r") + 1 - begin);
}

TableText parse_table_text(std::string_view text, const std::filesystem::path& path, const char* meant) {
    const ByteReader file(text, path);
    if (text.find('\0') != std::string_view::npos)
        file.fail(text.find('\0'), "", "a NUL", "text", "Export the table as plain text.");
    TableText table;
    std::optional<Style> style;
    int number = 0;
    for (std::size_t at = 0; at < text.size();) {
        const std::string_view line = text.substr(at, text.substr(at).find('\n'));
        at += line.size() + 1;
        ++number;
        const std::string_view content = bare(line);
        if (content.empty())
            continue;
        const Style own = style.value_or(style_of(content));
        if (content.starts_with('#') || (!style && !is_data(content, own))) {
            table.header.push_back(content);
            continue;
        }
        style = own;
        std::size_t count = 0;
        for (const std::string_view cell : cells_of(content, own.separator)) {
            const bool word = cell.find_first_of("0123456789") == std::string_view::npos;
            const auto value = number_of(cell, own);
            if (!value && !word)
                throw InputError({.where = {.file = file.file(), .line = number},
                                  .key = fmt::format("column {}", count + 1),
                                  .found = plain_line(cell.substr(0, 40)),
                                  .expected = "a number, or a word for a point that is not measured",
                                  .remedy = "Export the table anew, with one separator and one decimal sign."});
            table.values.push_back(value.value_or(std::numeric_limits<double>::quiet_NaN()));
            ++count;
        }
        if (table.rows > 0 && count != table.columns)
            throw InputError({.where = {.file = file.file(), .line = number},
                              .key = "columns",
                              .found = fmt::format("{}", count),
                              .expected = fmt::format("{}, as in the lines above", table.columns),
                              .remedy = "Export the table anew, with as many numbers in every line."});
        table.columns = count;
        ++table.rows;
    }
    if (table.rows == 0)
        file.fail({}, "", "no line of numbers", meant);
    table.separator = style->separator;
    return table;
}

} // namespace vkfv::surface
