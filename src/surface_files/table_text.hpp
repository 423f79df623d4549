// Numbers as lines of text.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

namespace vkfv::surface {

struct TableText {
    std::vector<std::string_view> header; // its lines, of the text that was parsed
    std::vector<double> values;           // row by row; NaN: not measured
    std::size_t columns = 0, rows = 0;    // at least one row
    char separator = ' ';                 // of the numbers; a blank: any number of blanks and tabs
};

// Numbers between commas, semicolons, tabs or blanks, in quotes or not; with decimal commas where another separator or
// the quotes leave no doubt. Lines before the first of numbers, and those that begin with '#', are a header; empty
// cells and words (NaN, BAD, ***) between numbers are not measured. text: UTF-8, as of as_utf8(). meant: what the file
// should have been ("a table of heights"). Throws InputError.
TableText parse_table_text(std::string_view text, const std::filesystem::path& path, const char* meant);

// Without the blanks around it.
std::string_view bare(std::string_view text);

} // namespace vkfv::surface
