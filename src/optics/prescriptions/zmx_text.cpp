#include "optics/prescriptions/zmx_text.hpp"

#include "core/messages/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <utility>

namespace vkfv::optics::zmx {

namespace {

constexpr std::size_t longest_quotation = 60; // characters of a line that a message repeats

constexpr std::string_view white_space = " \t\f\v\r";

std::vector<std::string> words_of(std::string_view text) {
    std::vector<std::string> words;
    for (std::size_t begin = text.find_first_not_of(white_space); begin != std::string_view::npos;) {
        const std::size_t end = std::min(text.find_first_of(white_space, begin), text.size());
        words.emplace_back(text.substr(begin, end - begin));
        begin = text.find_first_not_of(white_space, end);
    }
    return words;
}

// The files' text as UTF-8.
class Decoder {
  public:
    Decoder(std::string_view bytes, const std::filesystem::path& file) : bytes_(bytes), file_(file) {}

    std::string decode() {
        if (bytes_.starts_with("\xff\xfe") || bytes_.starts_with("\xfe\xff")) {
            return decode_utf16(bytes_.front() == '\xff');
        }
        if (bytes_.starts_with("\xef\xbb\xbf")) {
            bytes_.remove_prefix(3);
            offset_ = 3;
        }
        check_utf8();
        return std::string(bytes_);
    }

  private:
    [[noreturn]] void refuse(std::size_t position, const char* found) const {
        throw InputError({.where = {.file = file_, .byte_offset = offset_ + position},
                          .key = "",
                          .found = found,
                          .expected = "text in UTF-16 with a byte-order mark, or in UTF-8",
                          .remedy = "Save the lens in Zemax again, or convert the text to UTF-8."});
    }

    std::string decode_utf16(bool little_endian) const {
        const auto unit_at = [&](std::size_t i) {
            const auto first = static_cast<unsigned char>(bytes_[i]);
            const auto second = static_cast<unsigned char>(bytes_[i + 1]);
            return static_cast<std::uint32_t>(little_endian ? first | second << 8 : second | first << 8);
        };
        if (bytes_.size() % 2 != 0) {
            refuse(bytes_.size() - 1, "half a UTF-16 character");
        }
        std::string text;
        for (std::size_t i = 2; i < bytes_.size(); i += 2) {
            std::uint32_t point = unit_at(i);
            if (point >= 0xd800 && point < 0xe000) {
                const std::uint32_t low = i + 2 < bytes_.size() ? unit_at(i + 2) : 0;
                if (point >= 0xdc00 || low < 0xdc00 || low >= 0xe000) {
                    refuse(i, "half a UTF-16 surrogate pair");
                }
                point = 0x10000 + ((point - 0xd800) << 10) + (low - 0xdc00);
                i += 2;
            }
            if (point == 0) {
                refuse(i, "a NUL character");
            }
            append_utf8(text, point);
        }
        return text;
    }

    static void append_utf8(std::string& text, std::uint32_t point) {
        if (point < 0x80) {
            text += static_cast<char>(point);
            return;
        }
        const int following = point < 0x800 ? 1 : point < 0x10000 ? 2 : 3;
        constexpr std::uint32_t lead[] = {0, 0xc0, 0xe0, 0xf0};
        text += static_cast<char>(lead[following] | point >> (6 * following));
        for (int i = following - 1; i >= 0; --i) {
            text += static_cast<char>(0x80 | (point >> (6 * i) & 0x3f));
        }
    }

    // Well-formed as the Unicode standard's table 3-7 says: no overlong forms, no surrogates.
    void check_utf8() const {
        for (std::size_t i = 0; i < bytes_.size();) {
            const auto lead = static_cast<unsigned char>(bytes_[i]);
            if (lead == 0) {
                refuse(i, "a NUL character");
            }
            const std::size_t length = lead < 0x80 ? 1 : lead < 0xc2 ? 0 : lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : 4;
            if (length == 0 || lead > 0xf4 || i + length > bytes_.size()) {
                refuse(i, "bytes that are not UTF-8");
            }
            for (std::size_t j = 1; j < length; ++j) {
                const auto byte = static_cast<unsigned char>(bytes_[i + j]);
                const bool second = j == 1;
                const unsigned low = second && lead == 0xe0 ? 0xa0 : second && lead == 0xf0 ? 0x90 : 0x80;
                const unsigned high = second && lead == 0xed ? 0x9f : second && lead == 0xf4 ? 0x8f : 0xbf;
                if (byte < low || byte > high) {
                    refuse(i, "bytes that are not UTF-8");
                }
            }
            i += length;
        }
    }

    std::string_view bytes_;
    const std::filesystem::path& file_;
    std::size_t offset_ = 0;
};

} // namespace

std::string decode(std::string_view bytes, const std::filesystem::path& file) {
    return Decoder(bytes, file).decode();
}

Line line_of(std::string_view text, int number) {
    Line line{.number = number, .indented = text.starts_with(' ') || text.starts_with('\t')};
    line.rest = trimmed(text);
    const std::size_t end = line.rest.find_first_of(white_space);
    line.keyword = line.rest.substr(0, end);
    line.rest = end == std::string::npos ? "" : trimmed(std::string_view(line.rest).substr(end));
    line.words = words_of(line.rest);
    return line;
}

std::string trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(white_space);
    if (first == std::string_view::npos) {
        return {};
    }
    return std::string(text.substr(first, text.find_last_not_of(white_space) - first + 1));
}

std::optional<double> as_number(std::string_view word) {
    if (word.starts_with('+')) {
        word.remove_prefix(1);
    }
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) {
        return std::nullopt;
    }
    return value + 0.0; // no negative zeros
}

void refuse(const Place& place, const Line& line, std::string found, std::string expected, std::string remedy) {
    if (found.size() > longest_quotation) {
        found = found.substr(0, longest_quotation) + "...";
    }
    const std::string surface = place.surface ? fmt::format("surface {}: ", *place.surface) : "";
    throw InputError({.where = {.file = place.file, .line = line.number},
                      .key = surface + line.keyword.substr(0, longest_quotation),
                      .found = std::move(found),
                      .expected = std::move(expected),
                      .remedy = std::move(remedy)});
}

double number_at(const Place& place, const Line& line, std::size_t word, const NumberRange& range) {
    const auto value = word < line.words.size() ? as_number(line.words[word]) : std::nullopt;
    if (!value || !range.contains(*value)) {
        refuse(place, line, line.rest,
               trimmed(fmt::format("as value {} a finite number {}", word + 1, range.to_string())),
               "Correct the number; decimals take a point.");
    }
    return *value;
}

int integer_at(const Place& place, const Line& line, std::size_t word, int minimum, int maximum) {
    const double value = number_at(place, line, word);
    if (!(value >= minimum && value <= maximum && value == std::trunc(value))) {
        refuse(place, line, line.rest, fmt::format("as value {} an integer in [{}, {}]", word + 1, minimum, maximum),
               "Correct the number.");
    }
    return static_cast<int>(value);
}

} // namespace vkfv::optics::zmx
