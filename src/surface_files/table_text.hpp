// Tables of numbers as text.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

namespace vkfv::surface {

struct TableText {
    std::vector<std::string_view> header; // lines of the header, as views of the text
    std::vector<double> values;           // row by row; NaN: not measured
    std::size_t columns = 0, rows = 0;    // at least one row
    char separator = ' ';                 // between numbers; a blank: any number of blanks and tabs
};

// Parses numbers between commas, semicolons, tabs or blanks, in quotes or not; with decimal commas where another
// separator or the quotes leave no doubt. Lines before the first line of numbers, and those that begin with '#', are
// the header; empty cells and words (NaN, BAD, ***) between numbers are not measured, also in the first line of
// numbers. text: UTF-8, from as_utf8(). meant: the expected content, for messages ("a table of heights"). Throws
// InputError.
TableText parse_table_text(std::string_view text, const std::filesystem::path& path, const char* meant);

// The text without blanks at its ends.
std::string_view bare(std::string_view text);

} // namespace vkfv::surface
