// How deep a TOML text nests, told before anything recurses over it: the parser, the merging of tables and the end of a
// document all take stack by its depth.
#pragma once

#include <optional>
#include <string_view>

namespace vkfv {

// Wide of every configuration (six levels), and small for every stack.
constexpr int deepest_toml_nesting = 64;

struct TomlPlace {
    int line = 1;   // from 1
    int column = 1; // from 1, in characters
};

// Where the text first nests deeper than deepest_toml_nesting; none if it does not. Every part of a dotted name, every
// bracket and every brace is a level, except in strings and remarks. Of a text that is no TOML only what stands before
// the first fault is looked at, as a parser does.
std::optional<TomlPlace> too_deep_toml(std::string_view text);

} // namespace vkfv
