// Tables of numbers as CSV.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv {

struct NumberRow {
    std::vector<double> values; // one for each column
    int line = 0;
};

// Reads a table: the first line has the columns' names, each further line a row; empty lines are skipped. Throws
// InputError with line and column for anything else, also for numbers that are not finite and for a table without rows.
// key: the key or option that named the file; row_name: the word for a row: "ray".
std::vector<NumberRow> read_number_table(const std::filesystem::path& file,
                                         const std::vector<std::string_view>& columns, const std::string& key,
                                         const std::string& row_name);

} // namespace vkfv
