// Tables of numbers as CSV.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv {

struct NumberRow {
    std::vector<double> values; // one a column
    int line = 0;
};

// First line: the columns' names; then a row a line; empty lines are passed over. Throws InputError with line and
// column for anything else, also for numbers that are not finite and without a row. key: what the file is for; rows:
// "ray".
std::vector<NumberRow> read_number_table(const std::filesystem::path& file,
                                         const std::vector<std::string_view>& columns, const std::string& key,
                                         const std::string& row_name);

} // namespace vkfv
