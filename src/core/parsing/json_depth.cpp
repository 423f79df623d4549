#include "core/parsing/json_depth.hpp"

#include "core/messages/error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace vkfv {

TextPlace place_in(std::string_view text, std::size_t byte) {
    const std::string_view before = text.substr(0, std::min(byte, text.size()));
    const auto line_end = before.rfind('\n');
    const std::size_t line_start = line_end == std::string_view::npos ? 0 : line_end + 1;
    return {static_cast<int>(std::ranges::count(before, '\n')) + 1, static_cast<int>(before.size() - line_start) + 1};
}

void check_json_depth(std::string_view text, const std::filesystem::path& file,
                      std::optional<std::uint64_t> first_byte) {
    int depth = 0;
    bool in_string = false;
    for (std::size_t at = 0; at < text.size(); ++at) {
        const char character = text[at];
        if (in_string) {
            at += character == '\\' ? 1 : 0; // an escaped character does not end the string
            in_string = character != '"';
        } else if (character == '"') {
            in_string = true;
        } else if (character == ']' || character == '}') {
            --depth;
        } else if ((character == '[' || character == '{') && ++depth > most_json_depth) {
            const TextPlace place = place_in(text, at);
            SourceLocation where{.file = file, .line = place.line, .column = place.column};
            if (first_byte) {
                where = {.file = file, .byte_offset = *first_byte + at};
            }
            throw InputError(
                {where, "JSON", fmt::format("brackets nested {} deep", depth),
                 fmt::format("at most {} levels of brackets", most_json_depth),
                 "Remove what is nested so deep (in glTF mostly \"extras\"), or export the file without it."});
        }
    }
}

} // namespace vkfv
