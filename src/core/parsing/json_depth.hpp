// How deep the brackets of a JSON text may stand in one another.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

namespace vkfv {

// Readers that call themselves for every bracket take some kilobytes of the stack a level: this many fit into the
// smallest stacks, and no format in use comes near.
inline constexpr int most_json_depth = 100;

// To be called before any JSON reader. Brackets inside strings do not count; whether the text is JSON at all, the
// reader finds out. Throws InputError at the first bracket that is too deep: by line and column, or by its byte in the
// file where `first_byte` says at which byte of the file the text begins.
void check_json_depth(std::string_view text, const std::filesystem::path& file,
                      std::optional<std::uint64_t> first_byte = {});

// Line and column, from 1, of a byte of a text whose lines end with LF.
struct TextPlace {
    int line = 1;
    int column = 1;
};
TextPlace place_in(std::string_view text, std::size_t byte);

} // namespace vkfv
