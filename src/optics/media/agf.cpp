#include "optics/media/agf.hpp"

#include "core/files/file.hpp"
#include "core/messages/error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
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
        const int following = lead < 0x80 ? 0 : lead >> 5 == 6 ? 1 : lead >> 4 == 14 ? 2 : lead >> 3 == 30 ? 3 : -1;
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

// A line, or several where its numbers go on in the next ones.
struct Word {
    std::string_view text;
    int line = 0;
};

bool is_number(std::string_view word) {
    double value = 0;
    if (word.starts_with('+')) { // from_chars takes none
        word.remove_prefix(1);
    }
    return std::from_chars(word.data(), word.data() + word.size(), value).ptr == word.data() + word.size() &&
           !word.empty();
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
        // Some vendors' lines are wrapped: every line begins with letters, so one of numbers goes on with the last.
        if (pending_.empty() || !is_number(words[0])) {
            take_pending();
        }
        for (const auto word : words) {
            pending_.push_back({word, line_});
        }
    }

    std::vector<Medium> finish() {
        take_pending();
        finish_glass();
        if (media_.empty()) {
            throw InputError({.where = {.file = file_},
                              .key = "NM",
                              .found = "no glass",
                              .expected = "a glass catalogue in the AGF format",
                              .remedy = "Check that the file is a glass catalogue and complete."});
        }
        warn_of_twins();
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

    void take_pending() {
        if (pending_.empty()) {
            return;
        }
        const auto words = std::exchange(pending_, {});
        const std::string_view keyword = words[0].text;
        if (keyword == "NM") {
            finish_glass();
            begin_glass(words);
        } else if (keyword == "CD") {
            require_glass(words[0]);
            if (glass_->has_coefficients) {
                fail(words[0], keyword, joined(words), "one such line a glass", "Remove one of the two.");
            }
            glass_->has_coefficients = true;
            read_coefficients(words);
        } else if (keyword == "LD") {
            require_glass(words[0]);
            if (glass_->maximum_um > 0) {
                fail(words[0], keyword, joined(words), "one such line a glass", "Remove one of the two.");
            }
            read_range(words);
        } else if (std::find(skipped_keywords.begin(), skipped_keywords.end(), keyword) == skipped_keywords.end() &&
                   glass_) {
            fail(words[0], keyword, keyword,
                 "NM, CD, LD, or CC, GC, ED, TD, OD, IT, MD, BD, which are skipped, or numbers that continue a line",
                 "Correct the line, or begin it with '!' if it is a remark.");
        }
    }

    static std::string joined(const std::vector<Word>& words) {
        std::string text;
        for (const Word& word : words) {
            text += (text.empty() ? "" : " ") + std::string(word.text);
        }
        return text;
    }

    [[noreturn]] void fail(const Word& at, std::string_view key, std::string_view found, std::string expected,
                           std::string remedy) const {
        throw InputError({.where = {.file = file_, .line = at.line},
                          .key = glass_ ? fmt::format("{} of {}", key, quotation(glass_->name)) : std::string(key),
                          .found = quotation(found),
                          .expected = std::move(expected),
                          .remedy = std::move(remedy)});
    }

    double number(std::string_view keyword, const Word& word) const {
        std::string_view digits = word.text;
        if (digits.starts_with('+')) { // from_chars takes none
            digits.remove_prefix(1);
        }
        double value = 0;
        const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        // Out of range: from_chars leaves the value, whether it is too large or too small.
        if (code != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value)) {
            fail(word, keyword, word.text, "a finite number", "Correct this number.");
        }
        return value;
    }

    void require_glass(const Word& keyword) const {
        if (!glass_) {
            fail(keyword, keyword.text, keyword.text, "a line NM before it",
                 "Name the glass that this line belongs to.");
        }
    }

    void begin_glass(const std::vector<Word>& words) {
        if (words.size() < 3) {
            fail(words.back(), "NM", words.back().text, "a name and the number of a formula", "Complete the line.");
        }
        const double formula = number("NM", words[2]);
        if (!(formula >= 1 && formula <= static_cast<double>(dispersion_formula_names.size()) &&
              formula == std::trunc(formula))) {
            fail(words[2], "NM", words[2].text, "the number of a dispersion formula, 1 to 13", "Correct the number.");
        }
        glass_ = Glass{.name = std::string(words[1].text),
                       .line = words[0].line,
                       .formula = static_cast<DispersionFormula>(static_cast<int>(formula)),
                       .coefficients = {}};
    }

    void read_coefficients(const std::vector<Word>& words) {
        const std::size_t count = coefficient_count(glass_->formula);
        for (std::size_t i = 1; i < words.size(); ++i) {
            const double value = number("CD", words[i]);
            if (i > count && value != 0) {
                fail(words[i], "CD", words[i].text,
                     fmt::format("{} coefficients of formula {}, and zeros after them", count,
                                 static_cast<int>(glass_->formula)),
                     "Check the formula's number and the coefficients.");
            }
            if (i <= count) {
                glass_->coefficients.push_back(value);
            }
        }
        if (glass_->coefficients.empty()) {
            fail(words[0], "CD", "CD", "coefficients", "Complete the line.");
        }
    }

    void read_range(const std::vector<Word>& words) {
        if (words.size() < 3) {
            fail(words.back(), "LD", words.back().text, "the least and the greatest wavelength in um",
                 "Complete the line.");
        }
        glass_->minimum_um = number("LD", words[1]);
        glass_->maximum_um = number("LD", words[2]);
        if (!(glass_->minimum_um > 0 && glass_->maximum_um > glass_->minimum_um)) {
            fail(words[0], "LD", fmt::format("{} {}", words[1].text, words[2].text),
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
        add(Medium::formula(std::move(glass_->name), glass_->formula, std::move(glass_->coefficients),
                            glass_->minimum_um, glass_->maximum_um, file_.filename().string()),
            glass_->line);
        glass_.reset();
    }

    // Vendors' catalogues have names twice. The first stays: a search from the front finds it.
    void add(Medium medium, int line) {
        const auto [known, is_new] = index_of_.try_emplace(medium.name, media_.size());
        if (is_new) {
            lines_.push_back(line);
            media_.push_back(std::move(medium));
        } else if (media_[known->second].dispersion != medium.dispersion) {
            twins_.push_back(fmt::format("{} (lines {} and {})", medium.name, lines_[known->second], line));
        }
    }

    void warn_of_twins() const {
        constexpr std::size_t most_named = 10;
        if (twins_.empty()) {
            return;
        }
        const std::size_t named = std::min(twins_.size(), most_named);
        spdlog::warn(
            "{}: the same name stands for different glasses; the first of each is taken: {}{}. Rename the others "
            "to use them.",
            file_.string(), fmt::join(twins_.begin(), twins_.begin() + static_cast<std::ptrdiff_t>(named), ", "),
            twins_.size() > named ? fmt::format(" and {} more", twins_.size() - named) : "");
    }

    const std::filesystem::path& file_;
    int line_ = 0;
    std::vector<Word> pending_; // the last line, which may go on
    std::optional<Glass> glass_;
    std::map<std::string, std::size_t, std::less<>> index_of_; // of each name in media_
    std::vector<int> lines_;                                   // of each medium's NM
    std::vector<std::string> twins_;
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
