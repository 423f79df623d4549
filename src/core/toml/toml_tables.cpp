#include "core/toml/toml_tables.hpp"

#include <algorithm>
#include <sstream>

namespace vkfv {

std::string without_entries(const std::string& toml, std::initializer_list<std::string_view> names) {
    std::string text, table;
    const auto is_left_out = [&](const std::string& entry) {
        return std::ranges::any_of(names, [&](std::string_view name) {
            return entry == name || (entry.starts_with(name) && entry.substr(name.size()).starts_with('.'));
        });
    };
    std::istringstream lines(toml);
    for (std::string line; std::getline(lines, line);) {
        std::string entry;
        if (line.starts_with('[')) {
            const auto first = line.find_first_not_of('[');
            entry = table = line.substr(first, line.find(']') - first);
        } else {
            entry = (table.empty() ? "" : table + ".") + line.substr(0, line.find(' '));
        }
        text += is_left_out(entry) ? "" : line + "\n";
    }
    return text;
}

} // namespace vkfv
