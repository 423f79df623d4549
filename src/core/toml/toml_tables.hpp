// Canonical TOML as text, in which each table begins with its header on a line of its own.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace vkfv {

// The text without the tables of these names and the tables below them.
std::string without_tables(const std::string& toml, std::initializer_list<std::string_view> names);

} // namespace vkfv
