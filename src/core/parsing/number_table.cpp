#include "core/parsing/number_table.hpp"

#include "core/files/file.hpp"
#include "core/messages/error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <sstream>

namespace vkfv {

namespace {

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t");
    return first == std::string_view::npos ? std::string_view()
                                           : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

class Row {
  public:
    Row(const std::filesystem::path& file, int line, std::string_view text) : file_(file), line_(line), text_(text) {}

    [[noreturn]] void fail(std::size_t column, std::string_view key, std::string_view found, std::string expected,
                           std::string remedy) const {
        throw InputError({.where = {.file = file_, .line = line_, .column = static_cast<int>(column) + 1},
                          .key = std::string(key),
                          .found = fmt::format("\"{:.60}\"", found),
                          .expected = std::move(expected),
                          .remedy = std::move(remedy)});
    }

    std::vector<double> numbers(const std::vector<std::string_view>& columns) const {
        std::vector<double> values(columns.size());
        std::size_t begin = 0;
        for (std::size_t i = 0; i < columns.size(); ++i) {
            const bool last = i + 1 == columns.size();
            const std::size_t comma = text_.find(',', begin);
            if (last != (comma == std::string_view::npos)) {
                fail(last ? comma : text_.size(), columns[i], text_,
                     fmt::format("{} numbers: {}", columns.size(), fmt::join(columns, ",")),
                     last ? "Remove what follows the last number." : "Add the missing numbers.");
            }
            const std::string_view field = text_.substr(begin, last ? std::string_view::npos : comma - begin);
            std::string_view digits = trimmed(field);
            if (digits.starts_with('+')) {
                digits.remove_prefix(1);
            }
            const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), values[i]);
            if (code != std::errc() || end != digits.data() + digits.size() || !std::isfinite(values[i])) {
                fail(begin, columns[i], trimmed(field), "a finite number", "Correct this field.");
            }
            begin = comma + 1;
        }
        return values;
    }

  private:
    const std::filesystem::path& file_;
    int line_;
    std::string_view text_;
};

} // namespace

std::vector<NumberRow> read_number_table(const std::filesystem::path& file,
                                         const std::vector<std::string_view>& columns, const std::string& key,
                                         const std::string& row_name) {
    const std::string header = fmt::format("{}", fmt::join(columns, ","));
    std::istringstream stream(read_file(file, {.key = key, .expected = "a CSV file with the columns " + header}));
    std::vector<NumberRow> rows;
    std::string text;
    for (int line = 1; std::getline(stream, text); ++line) {
        if (text.ends_with('\r')) {
            text.pop_back();
        }
        const Row row(file, line, text);
        if (line == 1) {
            std::string compact;
            std::copy_if(text.begin(), text.end(), std::back_inserter(compact),
                         [](char character) { return character != ' ' && character != '\t'; });
            if (compact != header) {
                row.fail(0, "header", text, "the columns " + header,
                         "Name these columns, in this order, in the first line.");
            }
            continue;
        }
        if (!trimmed(text).empty()) {
            rows.push_back({row.numbers(columns), line});
        }
    }
    if (rows.empty()) {
        Row(file, 1, "")
            .fail(0, row_name + "s", "", fmt::format("at least one {} below the header", row_name),
                  fmt::format("Add a line with {} numbers.", columns.size()));
    }
    return rows;
}

} // namespace vkfv
