#include "specimen/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>
#include <unordered_map>

namespace vkfv::specimen {

namespace {

// Collects facets of three vertices, with one index for equal positions.
class Welder {
  public:
    void add(const glm::vec3& position) {
        // Adding zero makes -0 and 0 the same vertex.
        const glm::vec3 key = position + 0.0f;
        const auto [entry, is_new] = indices_.try_emplace(key, static_cast<std::uint32_t>(mesh_.vertices.size()));
        if (is_new) {
            mesh_.vertices.emplace_back(key);
        }
        corners_.push_back(entry->second);
        if (corners_.size() == 3) {
            mesh_.triangles.emplace_back(corners_[0], corners_[1], corners_[2]);
            corners_.clear();
        }
    }
    FileMesh take() { return std::move(mesh_); }

  private:
    struct Hash {
        std::size_t operator()(const glm::vec3& p) const {
            std::uint64_t hash = 0;
            for (int axis = 0; axis < 3; ++axis) {
                // The multiplier of Fibonacci hashing, 2^64 over the golden ratio.
                hash = (hash ^ std::bit_cast<std::uint32_t>(p[axis])) * 0x9E3779B97F4A7C15u;
                hash ^= hash >> 32;
            }
            return hash;
        }
    };
    FileMesh mesh_;
    std::vector<std::uint32_t> corners_;
    std::unordered_map<glm::vec3, std::uint32_t, Hash> indices_;
};

constexpr std::size_t binary_header = 80;
constexpr std::size_t binary_start = 84;    // offset after the count of triangles
constexpr std::size_t binary_triangle = 50; // normal, three vertices (float32), attribute (uint16)

static_assert(std::endian::native == std::endian::little, "STL is read in place");

FileMesh read_binary(std::string_view bytes, std::uint32_t count, const std::filesystem::path& file) {
    Welder welder;
    for (std::uint32_t triangle = 0; triangle < count; ++triangle) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::size_t offset = binary_start + triangle * binary_triangle + 12 * (corner + 1);
            glm::vec3 position;
            std::memcpy(&position, bytes.data() + offset, sizeof position);
            for (int axis = 0; axis < 3; ++axis) {
                if (!std::isfinite(position[axis])) {
                    throw InputError({{file, 0, 0, offset + 4 * static_cast<std::size_t>(axis)},
                                      fmt::format("triangle {}", triangle),
                                      fmt::format("{}", position[axis]),
                                      "a finite coordinate",
                                      "Export the file anew; it is damaged."});
                }
            }
            welder.add(position);
        }
    }
    return welder.take();
}

// The words of an ASCII STL with their places.
class Words {
  public:
    Words(std::string_view text, const std::filesystem::path& file) : text_(text), file_(file) {}

    // The next word in lower case; empty at the end of the file.
    std::string next() {
        while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) {
            step();
        }
        word_line_ = line_;
        word_column_ = static_cast<int>(at_ - line_start_) + 1;
        std::string word;
        while (at_ < text_.size() && !std::isspace(static_cast<unsigned char>(text_[at_]))) {
            word += static_cast<char>(std::tolower(static_cast<unsigned char>(text_[at_])));
            step();
        }
        return word;
    }
    void skip_line() {
        while (at_ < text_.size() && text_[at_] != '\n' && text_[at_] != '\r') {
            step();
        }
    }
    void expect(std::string_view keyword) {
        const std::string word = next();
        if (word != keyword) {
            fail(word, fmt::format("`{}`", keyword));
        }
    }
    float number() {
        const std::string word = next();
        const char* first = word.data() + (word.starts_with('+') ? 1 : 0);
        const char* last = word.data() + word.size();
        double value = 0;
        const auto [end, error] = std::from_chars(first, last, value);
        if (error != std::errc() || end != last || !std::isfinite(static_cast<float>(value))) {
            fail(word, "a finite number");
        }
        return static_cast<float>(value);
    }
    [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
        throw InputError({{file_, word_line_, word_column_, {}},
                          "STL",
                          found.empty() ? "the end of the file" : "`" + found.substr(0, 40) + "`",
                          expected,
                          "Export the file anew; it is damaged or truncated."});
    }

  private:
    // Lines end with LF, CR LF or, in old files, CR alone.
    void step() {
        const char character = text_[at_++];
        if (character == '\n' || (character == '\r' && (at_ == text_.size() || text_[at_] != '\n'))) {
            ++line_;
            line_start_ = at_;
        }
    }
    std::string_view text_;
    const std::filesystem::path& file_;
    std::size_t at_ = 0;
    std::size_t line_start_ = 0;
    int line_ = 1;
    int word_line_ = 1;
    int word_column_ = 1;
};

FileMesh read_ascii(std::string_view text, const std::filesystem::path& file) {
    Words words(text, file);
    Welder welder;
    words.expect("solid");
    for (;;) { // one pass per solid
        words.skip_line();
        std::string word;
        while ((word = words.next()) == "facet") {
            words.expect("normal");
            for (int axis = 0; axis < 3; ++axis) {
                words.next(); // skips the normal: exporters write nan for degenerate facets
            }
            words.expect("outer");
            words.expect("loop");
            for (int corner = 0; corner < 3; ++corner) {
                words.expect("vertex");
                const float x = words.number();
                const float y = words.number();
                const float z = words.number();
                welder.add({x, y, z});
            }
            words.expect("endloop");
            words.expect("endfacet");
        }
        if (word != "endsolid") {
            words.fail(word, "`facet` or `endsolid`");
        }
        words.skip_line();
        word = words.next();
        if (word.empty()) {
            return welder.take();
        }
        if (word != "solid") {
            words.fail(word, "`solid` or the end of the file");
        }
    }
}

constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
constexpr std::string_view wide_marks[] = {"\xff\xfe", "\xfe\xff"}; // byte-order marks of UTF-16

std::string lower_case(std::string_view text) {
    std::string result(text);
    std::transform(result.begin(), result.end(), result.begin(), [](unsigned char c) { return std::tolower(c); });
    return result;
}

// True if the file begins with "solid", as headers of binary files may too, and continues as text does.
bool looks_like_text(std::string_view text) {
    constexpr std::size_t head_bytes = 4096; // more than the name of any solid
    const std::string head = lower_case(text.substr(0, head_bytes));
    const std::size_t start = std::min(head.find_first_not_of(" \t\r\n"), head.size());
    const std::size_t first_control = static_cast<std::size_t>(
        std::find_if(head.begin(), head.end(),
                     [](unsigned char c) { return c < 0x20 && c != '\t' && c != '\r' && c != '\n'; }) -
        head.begin());
    return head.compare(start, 5, "solid") == 0 &&
           (first_control == head.size() || head.find("facet") != std::string::npos);
}

[[noreturn]] void fail(const std::filesystem::path& file, std::uint64_t offset, const std::string& found,
                       const std::string& expected,
                       const std::string& remedy = "Export the file anew; it is damaged.") {
    throw InputError({{file, 0, 0, offset}, "STL", found, expected, remedy});
}

FileMesh read_text(std::string_view text, std::uint64_t first_byte, const std::filesystem::path& file) {
    if (const auto zero = text.find('\0'); zero != std::string_view::npos) {
        fail(file, first_byte + zero, "a byte of 0 within an ASCII STL", "text");
    }
    return read_ascii(text, file);
}

} // namespace

FileMesh parse_stl(std::string_view bytes, const std::filesystem::path& file) {
    std::uint32_t count = 0;
    if (bytes.size() >= binary_start) {
        std::memcpy(&count, bytes.data() + binary_header, sizeof count);
    }
    const std::uint64_t binary_bytes = binary_start + binary_triangle * std::uint64_t{count};
    const std::size_t mark = bytes.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
    FileMesh mesh;
    if (bytes.size() >= binary_start && bytes.size() == binary_bytes) {
        mesh = read_binary(bytes, count, file);
    } else if (looks_like_text(bytes.substr(mark))) {
        mesh = read_text(bytes.substr(mark), mark, file);
    } else if (bytes.starts_with(wide_marks[0]) || bytes.starts_with(wide_marks[1])) {
        fail(file, 0, "text in UTF-16", "a binary STL, or an ASCII one in UTF-8", "Save the text as UTF-8.");
    } else if (mark > 0) {
        fail(file, mark, "text that does not begin with \"solid\"", "an STL file", "Name an STL file, or export one.");
    } else if (bytes.size() < binary_start) {
        fail(file, bytes.size(), fmt::format("{} bytes", bytes.size()),
             fmt::format("at least the {} bytes of a binary STL's header", binary_start));
    } else {
        fail(file, binary_header,
             fmt::format("neither ASCII (which begins with \"solid\"), nor binary: {} triangles in {} bytes", count,
                         bytes.size()),
             fmt::format("{} bytes for as many triangles", binary_bytes),
             "Export the file anew; it is damaged, truncated or no STL.");
    }
    if (mesh.triangles.empty()) {
        throw InputError({{file, 0, 0, {}},
                          "STL",
                          "0 triangles",
                          "at least one triangle",
                          "Export the mesh anew, or name another file."});
    }
    return mesh;
}

FileMesh read_stl(const std::filesystem::path& file, const SourceLocation& mention) {
    return parse_stl(specimen_bytes(file, mention), file);
}

} // namespace vkfv::specimen
