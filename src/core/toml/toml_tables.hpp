// Canonical TOML as text, in which each table begins with its header on a line of its own.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace vkfv {

// The text without the entries of these names: tables, with the tables below them, or dotted keys.
std::string without_entries(const std::string& toml, std::initializer_list<std::string_view> names);

} // namespace vkfv
