#include "core/toml/toml_nesting.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace vkfv {

namespace {

class Scanner {
  public:
    explicit Scanner(std::string_view text) : text_(text) {}

    std::optional<TomlPlace> first_too_deep() {
        while (at_ < text_.size() && !too_deep_) {
            const char character = text_[at_];
            if (character == '"' || character == '\'') {
                if (!skip_string(character)) {
                    break; // unterminated: the parser stops here too
                }
                continue;
            }
            if (character == '#') {
                at_ = std::min(text_.find('\n', at_), text_.size());
                continue;
            }
            take(character);
            ++at_;
        }
        return too_deep_;
    }

  private:
    struct Bracket {
        bool braces = false; // true: inline table; false: array
        int depth = 0;       // depth within it, without the key being read
    };

    void take(char character) {
        switch (character) {
        case '\n':
            ++line_;
            line_start_ = at_ + 1;
            if (open_.empty()) {
                begin_statement();
            }
            break;
        case '[':
        case '{':
            take_opening(character);
            break;
        case ']':
        case '}':
            if (!open_.empty()) {
                open_.pop_back();
                in_key_ = false;
            } else if (header_) {
                header_depth_ = depth_;
                in_key_ = false;
            }
            break;
        case '.':
            if (in_key_) {
                deepen();
            }
            break;
        case '=':
            in_key_ = false;
            break;
        case ',':
            in_key_ = !open_.empty() && open_.back().braces;
            if (!open_.empty()) {
                depth_ = open_.back().depth + (in_key_ ? 1 : 0);
                check();
            }
            break;
        case ' ':
        case '\t':
        case '\r':
            break;
        default:
            begun_ = true;
        }
    }

    // Starts a key of the last header's table; a bracket will show if it is the next header instead.
    void begin_statement() {
        header_ = false;
        begun_ = false;
        in_key_ = true;
        depth_ = header_depth_ + 1;
    }

    void take_opening(char character) {
        if (in_key_ && open_.empty() && !begun_) { // a header; the second bracket of two is an array's level
            depth_ = header_ ? depth_ + 1 : 1;
            begun_ = header_;
            header_ = true;
            check();
            return;
        }
        const bool braces = character == '{';
        if (!braces) { // a table's keys count as the level
            deepen();
        }
        if (!too_deep_) { // limits the stack to deepest_toml_nesting
            open_.push_back({.braces = braces, .depth = depth_});
        }
        in_key_ = braces;
        if (braces) {
            deepen();
        }
    }

    void deepen() {
        ++depth_;
        check();
    }

    void check() {
        if (depth_ > deepest_toml_nesting && !too_deep_) {
            int column = 1;
            for (std::size_t i = line_start_; i < at_; ++i) { // characters, not bytes
                column += (static_cast<unsigned char>(text_[i]) & 0xc0) != 0x80 ? 1 : 0;
            }
            too_deep_ = TomlPlace{.line = line_, .column = column};
        }
    }

    // Skips a string; false if it is unterminated. A string of one line ends with the line.
    bool skip_string(char quote) {
        begun_ = true;
        const std::string_view three(quote == '"' ? "\"\"\"" : "'''");
        const bool many_lines = text_.substr(at_).starts_with(three);
        at_ += many_lines ? 3 : 1;
        for (; at_ < text_.size(); ++at_) {
            const char character = text_[at_];
            if (character == '\n') {
                if (!many_lines) {
                    return false;
                }
                ++line_;
                line_start_ = at_ + 1;
            } else if (character == '\\' && quote == '"') {
                if (at_ + 1 < text_.size() && text_[at_ + 1] != '\n') {
                    ++at_;
                }
            } else if (character == quote && !many_lines) {
                ++at_;
                return true;
            } else if (character == quote && text_.substr(at_).starts_with(three)) {
                at_ += 3;
                for (int more = 0; more < 2 && at_ < text_.size() && text_[at_] == quote; ++more) {
                    ++at_; // up to two quotes may precede the three that end the string
                }
                return true;
            }
        }
        return false;
    }

    std::string_view text_;
    std::size_t at_ = 0;
    int line_ = 1;
    std::size_t line_start_ = 0;
    int header_depth_ = 0; // depth of the tables under the last header
    int depth_ = 1;
    bool header_ = false; // within [a.b] or [[a.b]]
    bool begun_ = false;  // the statement has any text yet
    bool in_key_ = true;
    std::vector<Bracket> open_; // brackets of the value being read
    std::optional<TomlPlace> too_deep_;
};

} // namespace

std::optional<TomlPlace> too_deep_toml(std::string_view text) {
    return Scanner(text).first_too_deep();
}

} // namespace vkfv
