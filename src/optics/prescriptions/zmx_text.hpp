// The text of a .zmx file: its lines, their numbers, and errors about them. Only the files of this import include this.
#pragma once

#include "core/toml/toml_reader.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv::optics::zmx {

struct Line {
    int number = 0;
    bool indented = false;
    std::string keyword{};
    std::string rest{};               // text behind the keyword, trimmed
    std::vector<std::string> words{}; // words of `rest`
};
Line line_of(std::string_view text, int number);

std::string trimmed(std::string_view text);
std::optional<double> as_number(std::string_view word); // none unless the word is a finite number

// The file and surface to which a line belongs, for messages.
struct Place {
    const std::filesystem::path& file;
    std::optional<int> surface{}; // number of the surface; none: the line concerns the lens
};

// Throws an InputError that names file, line, surface and keyword.
[[noreturn]] void refuse(const Place& place, const Line& line, std::string found, std::string expected,
                         std::string remedy);
double number_at(const Place& place, const Line& line, std::size_t word,
                 const NumberRange& range = NumberRange::finite());
int integer_at(const Place& place, const Line& line, std::size_t word, int minimum, int maximum);

} // namespace vkfv::optics::zmx
