#include "surface_files/table_text.hpp"

#include "core/parsing/byte_reader.hpp"
#include "surface_files/provenance.hpp"
#include "surface_files/table_header.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <optional>
#include <string>
#include <utility>

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

// The errors that spreadsheets write in place of a number. They begin with the '#' of a remark, but are cells.
constexpr std::array<std::string_view, 7> spreadsheet_errors = {"#N/A",  "#DIV/0!", "#VALUE!", "#REF!",
                                                                "#NUM!", "#NULL!",  "#NAME?"};

bool is_remark(std::string_view line) {
    return line.starts_with('#') &&
           std::ranges::none_of(spreadsheet_errors, [&](std::string_view error) { return line.starts_with(error); });
}

std::string in_small_letters(std::string_view text) {
    std::string word;
    for (const char c : text)
        word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return word;
}

// True for a word that programs write in place of a number, and in headers before the number that means the same.
bool is_word_for_a_gap(std::string_view cell) {
    constexpr std::array<std::string_view, 12> words = {"na",      "null", "none",   "bad",       "masked",  "invalid",
                                                        "missing", "void", "nodata", "undefined", "no data", "no_data"};
    return std::ranges::find(words, in_small_letters(cell)) != words.end();
}

// True for what programs write in place of a number that was not measured: nothing, dashes and stars, or one of their
// words.
bool is_gap(std::string_view cell) {
    if (cell.find_first_not_of("*-") == std::string_view::npos)
        return true;
    constexpr std::array<std::string_view, 10> forms = {"nan",     "inf",    "infinity", "n/a",      "1.#qnan",
                                                        "1.#snan", "1.#ind", "1.#inf",   "nan(ind)", "nan(snan)"};
    const std::string form = in_small_letters(cell.substr(cell[0] == '-' || cell[0] == '+' ? 1 : 0));
    return std::ranges::find(forms, form) != forms.end() || is_word_for_a_gap(cell) ||
           std::ranges::find(spreadsheet_errors, cell) != spreadsheet_errors.end();
}

// A line of data may begin with a gap, which is not a heading's word, if nothing but numbers and gaps follows. Of two
// cells a word and a number are a statement: "NODATA -9999".
bool is_data(std::string_view line, const Style& style) {
    const auto cells = cells_of(line, style.separator);
    const auto is_number = [&](std::string_view cell) { return number_of(cell, style).has_value(); };
    if (is_number(cells.front()))
        return true;
    const bool statement = cells.size() <= 2 && is_word_for_a_gap(cells.front());
    const bool any = std::ranges::any_of(cells, [](std::string_view cell) { return !cell.empty(); });
    return any && !statement &&
           std::ranges::all_of(cells, [&](std::string_view cell) { return is_number(cell) || is_gap(cell); });
}

// True for a line that holds alone how many lines follow, as some programs begin their lists of points.
bool is_count_of(std::string_view line, std::string_view rest) {
    const auto count = number_in<std::uint64_t>(line);
    if (!count || *count < 2)
        return false;
    std::uint64_t lines = 0;
    bool more_numbers = true;
    while (!rest.empty() && lines <= *count) {
        const std::string_view next = bare(rest.substr(0, rest.find('\n')));
        rest.remove_prefix(std::min(rest.find('\n'), rest.size() - 1) + 1);
        lines += next.empty() || is_remark(next) ? 0 : 1;
        more_numbers = more_numbers && (next.empty() || next.find_first_of(" \t,;") != std::string_view::npos);
    }
    return lines == *count && more_numbers;
}

// Appends a row, whose columns are as many as those of the rows before. An empty cell at the end of a line looks like a
// separator that closes the line: where the lines differ by it, the longer ones tell.
class Rows {
  public:
    explicit Rows(TableText& table) : table_(table) {}

    // Returns false if the row has another number of columns.
    bool append(const std::vector<double>& row, bool closed) {
        const std::size_t count = row.size();
        if (table_.rows == 0)
            table_.columns = count;
        const bool longer = count == table_.columns + 1 && all_closed_;
        const bool shorter = count + 1 == table_.columns && closed;
        if (count != table_.columns && !longer && !shorter)
            return false;
        if (longer)
            widen();
        table_.values.insert(table_.values.end(), row.begin(), row.end());
        if (shorter)
            table_.values.push_back(std::numeric_limits<double>::quiet_NaN());
        all_closed_ = all_closed_ && closed && !longer;
        ++table_.rows;
        return true;
    }

  private:
    // Gives each row so far a gap at its end.
    void widen() {
        std::vector<double> values;
        for (std::size_t row = 0; row < table_.rows; ++row) {
            const auto begin = table_.values.begin() + static_cast<std::ptrdiff_t>(row * table_.columns);
            values.insert(values.end(), begin, begin + static_cast<std::ptrdiff_t>(table_.columns));
            values.push_back(std::numeric_limits<double>::quiet_NaN());
        }
        table_.values = std::move(values);
        ++table_.columns;
    }

    TableText& table_;
    bool all_closed_ = true; // every line so far ends with a separator
};

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
    Rows rows(table);
    std::vector<double> row;
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
        if (is_remark(content) ||
            (!style && (!is_data(content, own) || is_count_of(content, text.substr(std::min(at, text.size())))))) {
            table.header.push_back(content);
            continue;
        }
        style = own;
        row.clear();
        for (const std::string_view cell : cells_of(content, own.separator)) {
            const bool word = cell.find_first_of("0123456789") == std::string_view::npos || is_gap(cell);
            const auto value = number_of(cell, own);
            if (!value && !word)
                throw InputError({.where = {.file = file.file(), .line = number},
                                  .key = fmt::format("column {}", row.size() + 1),
                                  .found = plain_line(cell.substr(0, 40)),
                                  .expected = "a number, or a word for a point that is not measured",
                                  .remedy = "Export the table anew, with one separator and one decimal sign."});
            row.push_back(value.value_or(std::numeric_limits<double>::quiet_NaN()));
        }
        const std::string_view whole = line.substr(0, line.find_last_not_of(" \r") + 1);
        if (!rows.append(row, own.separator != ' ' && whole.ends_with(own.separator)))
            throw InputError({.where = {.file = file.file(), .line = number},
                              .key = "columns",
                              .found = fmt::format("{}", row.size()),
                              .expected = fmt::format("{}, as in the lines above", table.columns),
                              .remedy = "Export the table anew, with as many numbers in every line."});
    }
    if (table.rows == 0)
        file.fail({}, "", "no line of numbers", meant);
    table.separator = style->separator;
    return table;
}

} // namespace vkfv::surface
