#include "core/messages/safe_text.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <utility>

namespace vkfv {

namespace {

// The safe text; characters of `kept` stay as they are.
std::string safe(std::string_view text, std::string_view kept) {
    std::string result;
    result.reserve(text.size());
    while (!text.empty()) {
        const Utf8Character character = first_character(text);
        const std::size_t bytes = character.bytes > 0 ? character.bytes : 1;
        const std::string_view own = text.substr(0, bytes);
        if (character.bytes == 0 || (character.code < 0x80 && is_unsafe_character(character.code) &&
                                     kept.find(text.front()) == std::string_view::npos)) {
            result += fmt::format("\\x{:02x}", static_cast<unsigned char>(text.front()));
        } else if (character.code >= 0x80 && is_unsafe_character(character.code)) {
            result += fmt::format("\\u{{{:04x}}}", character.code);
        } else {
            result += own;
        }
        text.remove_prefix(bytes);
    }
    return result;
}

} // namespace

// By the Unicode standard's table 3-7: without overlong forms and surrogates.
Utf8Character first_character(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i])); };
    const std::uint32_t lead = byte(0);
    if (lead < 0x80) {
        return {lead, 1};
    }
    const std::size_t bytes = lead < 0xc2 ? 0 : lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : lead < 0xf5 ? 4 : 0;
    if (bytes == 0 || text.size() < bytes) {
        return {};
    }
    std::uint32_t code = lead & (0x7fU >> bytes);
    for (std::size_t i = 1; i < bytes; ++i) {
        if ((byte(i) & 0xc0) != 0x80) {
            return {};
        }
        code = code << 6 | (byte(i) & 0x3f);
    }
    constexpr std::array<std::uint32_t, 5> least = {0, 0, 0x80, 0x800, 0x10000};
    const bool surrogate = code >= 0xd800 && code < 0xe000;
    return code < least[bytes] || code > 0x10ffff || surrogate ? Utf8Character{} : Utf8Character{code, bytes};
}

bool is_unsafe_character(std::uint32_t code) {
    constexpr std::array<std::pair<std::uint32_t, std::uint32_t>, 8> ranges = {
        {{0, 0x1f},          // control characters of ASCII
         {0x7f, 0x9f},       // delete, control characters of Latin-1
         {0x061c, 0x061c},   // Arabic letter mark
         {0x200e, 0x200f},   // marks of the direction of writing
         {0x2028, 0x202e},   // separators, overrides of the direction
         {0x2066, 0x2069},   // isolates of the direction
         {0xfeff, 0xfeff},   // byte-order mark
         {0xfffe, 0xffff}}}; // no characters, which XML forbids
    for (const auto& [first, last] : ranges) {
        if (code >= first && code <= last) {
            return true;
        }
    }
    return false;
}

std::string safe_text(std::string_view text) {
    return safe(text, "\n\t");
}

std::string safe_line(std::string_view text) {
    return safe(text, "");
}

std::string csv_cell(std::string_view text) {
    const std::string line = safe_line(text);
    if (line.find_first_of(",\"") == std::string::npos) {
        return line;
    }
    std::string quoted = "\"";
    for (const char character : line) {
        quoted += character;
        if (character == '"') {
            quoted += character;
        }
    }
    return quoted + '"';
}

void print_text(std::string_view text) {
    fmt::print("{}", safe_text(text));
}

} // namespace vkfv
