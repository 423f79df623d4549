#include "optics/media/agf.hpp"

#include "core/files/file.hpp"
#include "core/messages/error.hpp"
#include "core/parsing/text_encoding.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace vkfv::optics {

namespace {

constexpr std::array<std::string_view, 8> skipped_keywords = {"CC", "GC", "ED", "TD", "OD", "IT", "MD", "BD"};
constexpr std::size_t longest_quotation = 60; // characters of a line that a message quotes

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
    // The cut falls on the start of a UTF-8 character, so that a message stays valid text.
    std::size_t length = std::min(text.size(), longest_quotation);
    while (length < text.size() && length > 0 && (static_cast<unsigned char>(text[length]) & 0xc0) == 0x80) {
        --length;
    }
    return fmt::format("\"{}{}\"", text.substr(0, length), length < text.size() ? "..." : "");
}

// A logical line of the catalogue: its numbers may continue on the next physical lines.
struct Word {
    std::string_view text;
    int line = 0;
};

bool is_number(std::string_view word) {
    double value = 0;
    if (word.starts_with('+')) { // from_chars accepts no plus sign
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
        // Some vendors' catalogues are wrapped: every logical line begins with letters, so a line that begins with a
        // number continues the one before it.
        if (pending_.empty() || !is_number(words[0])) {
            take_pending();
        }
        for (const auto word : words) {
            pending_.push_back({word, line_});
        }
    }

    AgfGlasses finish() {
        take_pending();
        end_record();
        if (glasses_.media.empty() && glasses_.unusable.empty()) {
            throw InputError({.where = {.file = file_},
                              .key = "NM",
                              .found = "no glass",
                              .expected = "a glass catalogue in the AGF format",
                              .remedy = "Check that the file is a glass catalogue and complete."});
        }
        if (glasses_.media.empty()) { // no glass of the file is usable
            std::vector<InputProblem> problems;
            for (const auto& [name, problem] : glasses_.unusable) {
                problems.push_back(problem);
            }
            throw InputError(std::move(problems));
        }
        warn_of_twins();
        warn_of_unusable();
        return std::move(glasses_);
    }

  private:
    struct Glass {
        std::string name;
        int line = 0; // number of the glass's NM line
        DispersionFormula formula{};
        std::vector<double> coefficients;
        bool has_coefficients = false;
        double minimum_um = 0;
        double maximum_um = 0; // 0 before an LD line is read
    };

    // A fault in a record makes only its own glass unusable.
    void take_pending() {
        if (pending_.empty()) {
            return;
        }
        const auto words = std::exchange(pending_, {});
        const bool begins = words[0].text == "NM";
        if (begins) {
            end_record();
            skipping_ = false;
        }
        if (skipping_) {
            return;
        }
        try {
            take(words);
        } catch (const InputError& error) {
            skipping_ = true;
            const std::string name = glass_                       ? glass_->name
                                     : begins && words.size() > 1 ? std::string(words[1].text)
                                                                  : "";
            leave_out(name, error.problem());
        }
    }

    void take(const std::vector<Word>& words) {
        const std::string_view keyword = words[0].text;
        if (keyword == "NM") {
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

    void end_record() {
        try {
            finish_glass();
        } catch (const InputError& error) {
            leave_out(glass_->name, error.problem());
        }
    }

    void leave_out(const std::string& name, const InputProblem& problem) {
        glasses_.unusable.try_emplace(name, problem);
        glass_.reset();
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
        if (digits.starts_with('+')) { // from_chars accepts no plus sign
            digits.remove_prefix(1);
        }
        double value = 0;
        const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        // from_chars leaves the value unchanged when it is out of range, too large and too small alike.
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

    // Vendors' catalogues contain some names twice. The first glass stays, because a search from the front finds it.
    void add(Medium medium, int line) {
        const auto [known, is_new] = index_of_.try_emplace(medium.name, glasses_.media.size());
        if (is_new) {
            lines_.push_back(line);
            glasses_.media.push_back(std::move(medium));
        } else if (glasses_.media[known->second].dispersion != medium.dispersion) {
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

    void warn_of_unusable() const {
        for (const auto& [name, problem] : glasses_.unusable) {
            spdlog::warn("{}: {} = {}: expected {}. {} is left out", problem.where.to_string(), problem.key,
                         problem.found, problem.expected, name.empty() ? "The record" : "The glass " + name);
        }
    }

    const std::filesystem::path& file_;
    int line_ = 0;
    bool skipping_ = false;     // true while the rest of an unusable record is skipped
    std::vector<Word> pending_; // words of the last logical line, which the next physical line may continue
    std::optional<Glass> glass_;
    std::map<std::string, std::size_t, std::less<>> index_of_; // index into glasses_.media by name
    std::vector<int> lines_;                                   // number of the NM line of each medium
    std::vector<std::string> twins_;
    AgfGlasses glasses_;
};

} // namespace

AgfGlasses parse_agf(std::string_view bytes, const std::filesystem::path& name) {
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

AgfGlasses read_agf(const std::filesystem::path& file) {
    return parse_agf(read_file(file, {.expected = "a glass catalogue (.agf)"}), file);
}

} // namespace vkfv::optics
