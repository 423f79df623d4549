// Finds how deep a TOML text nests, before any recursion over it: the parser, the merging of tables and the destruction
// of a document all need stack in proportion to the depth.
#pragma once

#include <optional>
#include <string_view>

namespace vkfv {

// The limit: more than any configuration needs (six levels), and little for any stack.
constexpr int deepest_toml_nesting = 64;

struct TomlPlace {
    int line = 1;   // from 1
    int column = 1; // from 1, in characters
};

// The place where the text first nests deeper than deepest_toml_nesting; none if it does not. Every part of a dotted
// name, every bracket and every brace is a level, except in strings and comments. Invalid TOML is examined only up to
// its first fault, where a parser stops too.
std::optional<TomlPlace> too_deep_toml(std::string_view text);

} // namespace vkfv
