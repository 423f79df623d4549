#include "images/pnm_header.hpp"

#include "core/parsing/byte_reader.hpp"

#include <algorithm>
#include <cctype>

namespace vkfv::images {
namespace {

// The words of a header, between blanks and comments that extend to the end of their line.
class Words {
  public:
    Words(std::string_view bytes, const ByteReader& file) : bytes_(bytes), file_(file) {}

    std::string_view next(const char* what) {
        while (at_ < bytes_.size() && (blank() || bytes_[at_] == '#')) {
            at_ = bytes_[at_] == '#' ? std::min(bytes_.find('\n', at_), bytes_.size()) : at_ + 1;
        }
        const std::uint64_t begin = at_;
        while (at_ < bytes_.size() && !blank()) {
            ++at_;
        }
        if (begin == at_) {
            file_.fail(begin, what, "the end of the file", "a number");
        }
        return bytes_.substr(begin, at_ - begin);
    }
    template <class Value>
    Value number(const char* what) {
        const std::string_view word = next(what);
        const auto value = number_in<Value>(word);
        if (!value) {
            file_.fail(at_ - word.size(), what, std::string(word.substr(0, 20)), "a number");
        }
        return *value;
    }
    std::uint64_t rest() const { return bytes_.size() - at_; }

  private:
    bool blank() const { return std::isspace(static_cast<unsigned char>(bytes_[at_])) != 0; }

    std::string_view bytes_;
    const ByteReader& file_;
    std::uint64_t at_ = 2; // offset behind "P5"
};

} // namespace

bool looks_like_pnm(std::string_view bytes) {
    return bytes.size() > 2 && bytes[0] == 'P' &&
           std::string_view("123456fF").find(bytes[1]) != std::string_view::npos &&
           std::isspace(static_cast<unsigned char>(bytes[2])) != 0;
}

void check_pnm(std::string_view bytes, const std::filesystem::path& path) {
    const ByteReader file(bytes, path);
    const char kind = bytes[1];
    Words words(bytes, file);
    const auto columns = words.number<std::uint64_t>("columns"), rows = words.number<std::uint64_t>("rows");
    file.check_size(columns, rows);
    const bool floats = kind == 'f' || kind == 'F', bits = kind == '1' || kind == '4', text = kind <= '3';
    std::uint64_t value_bytes = 4;
    if (floats) {
        (void)words.number<double>("scale");
    } else if (!bits) {
        const auto largest = words.number<std::uint64_t>("largest value");
        if (largest < 1 || largest > 65535) {
            file.fail({}, "largest value", fmt::format("{}", largest), "from 1 to 65535");
        }
        value_bytes = largest > 255 ? 2 : 1;
    }
    const std::uint64_t values = columns * (kind == '3' || kind == '6' || kind == 'F' ? 3 : 1);
    // In text each value takes at least a digit, and a blank before it unless it is a bit.
    const std::uint64_t row_bytes = text   ? (bits ? values : 2 * values)
                                    : bits ? (values + 7) / 8
                                           : values * value_bytes;
    if (row_bytes * rows > words.rest()) {
        file.fail({}, "size", fmt::format("{} x {} pixels in {} bytes", columns, rows, words.rest()),
                  fmt::format("at least {} bytes for them", row_bytes * rows));
    }
}

} // namespace vkfv::images
