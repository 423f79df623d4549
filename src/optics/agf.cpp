#include "optics/agf.hpp"

#include "core/error.hpp"
#include "core/file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace vkfv::optics {

namespace {

constexpr std::array<std::string_view, 8> skipped_keywords = {"CC", "GC", "ED", "TD", "OD", "IT", "MD", "BD"};
constexpr std::size_t longest_quotation = 60; // characters of a line that a message repeats

void append_utf8(std::string& text, std::uint32_t code) {
    if (code < 0x80) {
        text += static_cast<char>(code);
    } else if (code < 0x800) {
        text += static_cast<char>(0xc0 | (code >> 6));
        text += static_cast<char>(0x80 | (code & 0x3f));
    } else if (code < 0x10000) {
        text += static_cast<char>(0xe0 | (code >> 12));
        text += static_cast<char>(0x80 | ((code >> 6) & 0x3f));
        text += static_cast<char>(0x80 | (code & 0x3f));
    } else {
        text += static_cast<char>(0xf0 | (code >> 18));
        text += static_cast<char>(0x80 | ((code >> 12) & 0x3f));
        text += static_cast<char>(0x80 | ((code >> 6) & 0x3f));
        text += static_cast<char>(0x80 | (code & 0x3f));
    }
}

// UTF-16 with a byte-order mark as UTF-8; half a surrogate pair becomes a question mark.
std::string utf8_of_utf16(std::string_view bytes, bool big_endian) {
    const auto unit = [&](std::size_t i) {
        const auto first = static_cast<unsigned char>(bytes[i]);
        const auto second = static_cast<unsigned char>(bytes[i + 1]);
        return static_cast<std::uint32_t>(big_endian ? first << 8 | second : second << 8 | first);
    };
    std::string text;
    text.reserve(bytes.size() / 2);
    for (std::size_t i = 2; i + 1 < bytes.size(); i += 2) {
        const std::uint32_t high = unit(i);
        if (high < 0xd800 || high >= 0xe000) {
            append_utf8(text, high);
            continue;
        }
        const std::uint32_t low = high < 0xdc00 && i + 3 < bytes.size() ? unit(i + 2) : 0;
        if (low >= 0xdc00 && low < 0xe000) {
            append_utf8(text, 0x10000 + ((high - 0xd800) << 10) + (low - 0xdc00));
            i += 2;
        } else {
            text += '?';
        }
    }
    return text;
}

bool is_utf8(std::string_view text) {
    for (std::size_t i = 0; i < text.size();) {
        const auto lead = static_cast<unsigned char>(text[i++]);
        const int following = lead < 0x80       ? 0
                              : lead >> 5 == 6  ? 1
                              : lead >> 4 == 14 ? 2
                              : lead >> 3 == 30 ? 3
                                                : -1;
        if (following < 0) {
            return false;
        }
        for (int k = 0; k < following; ++k, ++i) {
            if (i == text.size() || (static_cast<unsigned char>(text[i]) & 0xc0) != 0x80) {
                return false;
            }
        }
    }
    return true;
}

// Messages and names are UTF-8 whatever the file is.
std::string as_utf8(std::string_view bytes) {
    if (bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff")) {
        return utf8_of_utf16(bytes, bytes.starts_with("\xfe\xff"));
    }
    if (bytes.starts_with("\xef\xbb\xbf")) {
        bytes.remove_prefix(3);
    }
    if (is_utf8(bytes)) {
        return std::string(bytes);
    }
    std::string text;
    text.reserve(bytes.size() + bytes.size() / 8);
    for (const char byte : bytes) { // Latin-1: a byte is its code point
        append_utf8(text, static_cast<unsigned char>(byte));
    }
    return text;
}

bool is_space(char character) {
    return character == ' ' || character == '\t' || character == '\v' || character == '\f';
}

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    for (std::size_t i = 0; i < line.size();) {
        if (is_space(line[i])) {
            ++i;
            continue;
        }
        const std::size_t first = i;
        while (i < line.size() && !is_space(line[i])) {
            ++i;
        }
        words.push_back(line.substr(first, i - first));
    }
    return words;
}

std::string quotation(std::string_view text) {
    // Cut where a character begins.
    std::size_t length = std::min(text.size(), longest_quotation);
    while (length < text.size() && length > 0 && (static_cast<unsigned char>(text[length]) & 0xc0) == 0x80) {
        --length;
    }
    return fmt::format("\"{}{}\"", text.substr(0, length), length < text.size() ? "..." : "");
}

class Reader {
  public:
    explicit Reader(const std::filesystem::path& file) : file_(file) {}

    void read_line(std::string_view line) {
        ++line_;
        const auto words = words_of(line);
        if (words.empty() || words[0][0] == '!' || words[0][0] == '#') {
            return;
        }
        const std::string_view keyword = words[0];
        if (keyword == "NM") {
            finish_glass();
            begin_glass(words);
        } else if (keyword == "CD") {
            require_glass(keyword);
            if (glass_->has_coefficients) {
                fail(keyword, line, "one such line a glass", "Remove one of the two.");
            }
            glass_->has_coefficients = true;
            read_coefficients(words);
        } else if (keyword == "LD") {
            require_glass(keyword);
            if (glass_->maximum_um > 0) {
                fail(keyword, line, "one such line a glass", "Remove one of the two.");
            }
            read_range(words);
        } else if (std::find(skipped_keywords.begin(), skipped_keywords.end(), keyword) ==
                       skipped_keywords.end() &&
                   glass_) {
            fail(keyword, keyword, "NM, CD, LD, or CC, GC, ED, TD, OD, IT, MD, BD, which are skipped",
                 "Correct the line, or begin it with '!' if it is a remark.");
        }
    }

    std::vector<Medium> finish() {
        finish_glass();
        if (media_.empty()) {
            throw InputError({.where = {.file = file_},
                              .key = "NM",
                              .found = "no glass",
                              .expected = "a glass catalogue in the AGF format",
                              .remedy = "Check that the file is a glass catalogue and complete."});
        }
        return std::move(media_);
    }

  private:
    struct Glass {
        std::string name;
        int line = 0; // of its NM
        DispersionFormula formula{};
        std::vector<double> coefficients;
        bool has_coefficients = false;
        double minimum_um = 0;
        double maximum_um = 0; // 0: no LD yet
    };

    [[noreturn]] void fail(std::string_view key, std::string_view found, std::string expected,
                           std::string remedy) const {
        throw InputError(
            {.where = {.file = file_, .line = line_},
             .key = glass_ ? fmt::format("{} of {}", key, quotation(glass_->name)) : std::string(key),
             .found = quotation(found),
             .expected = std::move(expected),
             .remedy = std::move(remedy)});
    }

    double number(std::string_view keyword, std::string_view word) const {
        std::string_view digits = word;
        if (digits.starts_with('+')) { // from_chars takes none
            digits.remove_prefix(1);
        }
        double value = 0;
        const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        // Out of range: from_chars leaves the value, whether it is too large or too small.
        if (code != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value)) {
            fail(keyword, word, "a finite number", "Correct this number.");
        }
        return value;
    }

    void require_glass(std::string_view keyword) const {
        if (!glass_) {
            fail(keyword, keyword, "a line NM before it", "Name the glass that this line belongs to.");
        }
    }

    void begin_glass(const std::vector<std::string_view>& words) {
        if (words.size() < 3) {
            fail("NM", words.back(), "a name and the number of a formula", "Complete the line.");
        }
        const double formula = number("NM", words[2]);
        if (!(formula >= 1 && formula <= static_cast<double>(dispersion_formula_names.size()) &&
              formula == std::trunc(formula))) {
            fail("NM", words[2], "the number of a dispersion formula, 1 to 13", "Correct the number.");
        }
        if (!names_.emplace(words[1]).second) {
            fail("NM", words[1], "a name that no glass before it has", "Rename or remove one of the two.");
        }
        glass_ = Glass{.name = std::string(words[1]),
                       .line = line_,
                       .formula = static_cast<DispersionFormula>(static_cast<int>(formula)),
                       .coefficients = {}};
    }

    void read_coefficients(const std::vector<std::string_view>& words) {
        const std::size_t count = coefficient_count(glass_->formula);
        for (std::size_t i = 1; i < words.size(); ++i) {
            const double value = number("CD", words[i]);
            if (i > count && value != 0) {
                fail("CD", words[i],
                     fmt::format("{} coefficients of formula {}, and zeros after them", count,
                                 static_cast<int>(glass_->formula)),
                     "Check the formula's number and the coefficients.");
            }
            if (i <= count) {
                glass_->coefficients.push_back(value);
            }
        }
        if (glass_->coefficients.empty()) {
            fail("CD", "CD", "coefficients", "Complete the line.");
        }
    }

    void read_range(const std::vector<std::string_view>& words) {
        if (words.size() < 3) {
            fail("LD", words.back(), "the least and the greatest wavelength in um", "Complete the line.");
        }
        glass_->minimum_um = number("LD", words[1]);
        glass_->maximum_um = number("LD", words[2]);
        if (!(glass_->minimum_um > 0 && glass_->maximum_um > glass_->minimum_um)) {
            fail("LD", fmt::format("{} {}", words[1], words[2]),
                 "two wavelengths in um, positive and ascending", "Correct the range.");
        }
    }

    void finish_glass() {
        if (!glass_) {
            return;
        }
        const char* missing = !glass_->has_coefficients ? "CD" : glass_->maximum_um == 0 ? "LD" : nullptr;
        if (missing) {
            throw InputError({.where = {.file = file_, .line = glass_->line},
                              .key = fmt::format("{} of {}", missing, quotation(glass_->name)),
                              .found = "nothing",
                              .expected = fmt::format("a line {} after this NM", missing),
                              .remedy = "Complete the glass, or remove it."});
        }
        media_.push_back(Medium::formula(std::move(glass_->name), glass_->formula,
                                         std::move(glass_->coefficients), glass_->minimum_um,
                                         glass_->maximum_um, file_.filename().string()));
        glass_.reset();
    }

    const std::filesystem::path& file_;
    int line_ = 0;
    std::optional<Glass> glass_;
    std::set<std::string, std::less<>> names_;
    std::vector<Medium> media_;
};

} // namespace

std::vector<Medium> parse_agf(std::string_view bytes, const std::filesystem::path& name) {
    const std::string text = as_utf8(bytes);
    Reader reader(name);
    for (std::string_view rest = text; !rest.empty();) {
        const std::size_t length = std::min(rest.find('\n'), rest.size());
        std::string_view line = rest.substr(0, length);
        if (line.ends_with('\r')) {
            line.remove_suffix(1);
        }
        reader.read_line(line);
        rest.remove_prefix(std::min(length + 1, rest.size()));
    }
    return reader.finish();
}

std::vector<Medium> read_agf(const std::filesystem::path& file) {
    return parse_agf(read_file(file, {.expected = "a glass catalogue (.agf)"}), file);
}

} // namespace vkfv::optics
