// Converts text files of other programs to UTF-8, whatever their encoding.
#pragma once

#include <string>
#include <string_view>

namespace vkfv {

// The bytes of a text file as UTF-8, without a byte-order mark. Recognized are UTF-8, UTF-16 with a byte-order mark and
// UTF-16 of mostly Latin letters without one; all other bytes are taken as Latin-1. Half a surrogate pair becomes a
// question mark, and half a character at the end is left out. Lines that end with a carriage return alone, as on old
// Macintoshes and in one of Excel's formats, end with a line feed. NUL characters are kept; callers must check for
// them.
std::string as_utf8(std::string_view bytes);

// True for well-formed UTF-8.
bool is_utf8(std::string_view text);

} // namespace vkfv
