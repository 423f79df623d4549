// Limits the depth to which the brackets of a JSON text are nested.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

namespace vkfv {

// The largest depth. Recursive readers take some kilobytes of stack for each level: this many fit into the smallest
// stacks, and no format in use comes near.
inline constexpr int most_json_depth = 100;

// Checks the depth before a JSON reader is called. Brackets inside strings do not count; whether the text is valid JSON
// is left to the reader. Throws InputError at the first bracket that is too deep: by line and column, or by its byte in
// the file if `first_byte` gives the byte of the file at which the text begins.
void check_json_depth(std::string_view text, const std::filesystem::path& file,
                      std::optional<std::uint64_t> first_byte = {});

// Line and column, from 1, of a byte of a text whose lines end with LF.
struct TextPlace {
    int line = 1;
    int column = 1;
};
TextPlace place_in(std::string_view text, std::size_t byte);

} // namespace vkfv
