#include "core/toml/toml_tables.hpp"

#include <algorithm>
#include <sstream>

namespace vkfv {

std::string without_tables(const std::string& toml, std::initializer_list<std::string_view> names) {
    std::string text;
    bool kept = true;
    std::istringstream lines(toml);
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with('[')) {
            const auto first = line.find_first_not_of('[');
            const std::string_view table = std::string_view(line).substr(first, line.find(']') - first);
            kept = std::ranges::none_of(names, [&](std::string_view name) {
                return table == name || (table.starts_with(name) && table.substr(name.size()).starts_with('.'));
            });
        }
        text += kept ? line + "\n" : "";
    }
    return text;
}

} // namespace vkfv
