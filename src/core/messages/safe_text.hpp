// Text from outside, such as names of files, labels and comments, made safe wherever it is shown or written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace vkfv {

// The text with escapes "\xNN" (a byte) and "\u{NNNN}" (a character) in place of what a terminal obeys or a reader
// cannot see: control characters of ASCII and of Latin-1, marks that reverse the direction of writing, separators of
// lines and paragraphs, and bytes that are not UTF-8. Ends of lines and tabs are kept.
std::string safe_text(std::string_view text);

// safe_text() for a text that must stay in its line, its cell or its name: ends of lines and tabs are escaped too.
std::string safe_line(std::string_view text);

// The text, in a line, as a cell of a CSV file (RFC 4180): in quotes where it needs them.
std::string csv_cell(std::string_view text);

// The code of the character of UTF-8 that the text, which is not empty, begins with, and its number of bytes; 0 bytes:
// it begins with none.
struct Utf8Character {
    std::uint32_t code = 0;
    std::size_t bytes = 0;
};
Utf8Character first_character(std::string_view text);

// True for a character that safe_line() escapes.
bool is_unsafe_character(std::uint32_t code);

// Prints safe_text() of a text on standard output.
void print_text(std::string_view text);

} // namespace vkfv
