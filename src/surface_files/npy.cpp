#include "surface_files/npy.hpp"

#include "core/mathematics/units.hpp"
#include "core/parsing/byte_reader.hpp"
#include "surface_files/image_scale.hpp"
#include "surface_files/lengths.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace vkfv::surface {
namespace {

constexpr std::string_view npy_magic = "\x93NUMPY";
constexpr std::size_t major_at = 6, length_at = 8, npy_alignment = 64;
constexpr std::string_view blanks = " \t\n";

// The text behind "'key':" in the header, a dictionary in Python's notation.
std::string_view value_of(const ByteReader& file, std::string_view header, const char* key) {
    for (const char quote : {'\'', '"'}) {
        const std::string name = fmt::format("{}{}{}", quote, key, quote);
        const auto at = header.find(name);
        if (at == std::string_view::npos)
            continue;
        const auto colon = header.find_first_not_of(blanks, at + name.size());
        if (colon == std::string_view::npos || header[colon] != ':')
            break;
        const auto begin = header.find_first_not_of(blanks, colon + 1);
        if (begin != std::string_view::npos)
            return header.substr(begin);
    }
    file.fail(length_at, key, "nothing", "a header of NumPy with it");
}

struct Shape {
    std::uint64_t rows, columns;
};

// The shape of a map: two lengths, besides any lengths of 1, which are ignored.
Shape shape_of(const ByteReader& file, std::string_view text) {
    const auto end = text.find(')');
    std::vector<std::uint64_t> lengths;
    bool good = text.starts_with('(') && end != std::string_view::npos;
    for (std::size_t at = 1; good && at < end;) {
        const std::size_t comma = std::min(text.find(',', at), end);
        const std::string_view length = text.substr(at, comma - at);
        at = comma + 1;
        if (length.find_first_not_of(blanks) == std::string_view::npos)
            continue; // Python's notation allows a comma at the end
        const auto value = number_in<std::uint64_t>(length);
        good = value.has_value();
        lengths.push_back(value.value_or(0));
    }
    for (auto one = std::ranges::find(lengths, 1u); lengths.size() > 2 && one != lengths.end();
         one = std::ranges::find(lengths, 1u))
        lengths.erase(one);
    if (!good || lengths.size() != 2)
        file.fail(length_at, "shape", plain_line(text.substr(0, std::min<std::size_t>(end, 60))),
                  "two dimensions, rows and columns", "Save one height map as an array of two dimensions.");
    return {lengths[0], lengths[1]};
}

struct Element {
    char kind;         // 'f', 'i' or 'u'
    std::size_t bytes; // bytes of an element
    bool swapped;      // true for big-endian
};

Element element_of(const ByteReader& file, std::string_view text) {
    const std::string_view name = text.substr(0, std::min<std::size_t>(text.size(), 5)); // for example '<f8'
    const bool order = name.size() == 5 && std::string_view("<>|=").find(name[1]) != std::string_view::npos;
    if (order && std::string_view("fiu").find(name[2]) != std::string_view::npos && (name[4] == '\'' || name[4] == '"'))
        for (const std::size_t bytes : {1, 2, 4, 8})
            if (static_cast<std::size_t>(name[3] - '0') == bytes && !(name[2] == 'f' && bytes < 2))
                return {name[2], bytes, name[1] == '>'};
    file.fail(length_at, "descr", plain_line(name), "f2, f4, f8, or integers i or u of 1, 2, 4 or 8 bytes",
              "Save the array as float64.");
}

template <class Stored>
double value_at(std::string_view points, std::size_t index, bool swapped) {
    std::array<char, sizeof(Stored)> bytes{};
    std::ranges::copy(points.substr(index * sizeof(Stored), sizeof(Stored)), bytes.begin());
    if (swapped)
        std::ranges::reverse(bytes);
    return static_cast<double>(std::bit_cast<Stored>(bytes));
}

// The value of an element in IEEE 754's binary16.
double half_at(std::string_view points, std::size_t index, bool swapped) {
    const auto bits = static_cast<std::uint16_t>(value_at<std::uint16_t>(points, index, swapped));
    const int exponent = bits >> 10 & 0x1f, fraction = bits & 0x3ff;
    constexpr int bias = 15, fraction_bits = 10;
    const double size = exponent == 0x1f ? (fraction == 0 ? INFINITY : NAN)
                        : exponent == 0  ? std::ldexp(fraction, 1 - bias - fraction_bits)
                                         : std::ldexp(0x400 + fraction, exponent - bias - fraction_bits);
    return (bits & 0x8000) != 0 ? -size : size;
}

using ValueAt = double (*)(std::string_view, std::size_t, bool);

ValueAt reader_of(const Element& type) {
    if (type.kind == 'f')
        return type.bytes == 2 ? half_at : type.bytes == 4 ? value_at<float> : value_at<double>;
    const bool with_sign = type.kind == 'i';
    switch (type.bytes) {
    case 1:
        return with_sign ? value_at<std::int8_t> : value_at<std::uint8_t>;
    case 2:
        return with_sign ? value_at<std::int16_t> : value_at<std::uint16_t>;
    case 4:
        return with_sign ? value_at<std::int32_t> : value_at<std::uint32_t>;
    default:
        return with_sign ? value_at<std::int64_t> : value_at<std::uint64_t>;
    }
}

} // namespace

bool looks_like_npy(std::string_view bytes) {
    return bytes.starts_with(npy_magic);
}

SurfaceFile parse_npy(std::string_view bytes, const std::filesystem::path& path, const ImageScale& scale) {
    check_scale(path, scale);
    const ByteReader file(bytes, path);
    const int major = file.at<std::uint8_t>(major_at, "version");
    if (major < 1 || major > 3)
        file.fail(major_at, "version", fmt::format("{}", major), "1, 2 or 3");
    const std::uint64_t length = major == 1 ? file.at<std::uint16_t>(length_at, "length of the header")
                                            : file.at<std::uint32_t>(length_at, "length of the header");
    const std::uint64_t header_at = length_at + (major == 1 ? sizeof(std::uint16_t) : sizeof(std::uint32_t));
    const auto header = file.bytes(header_at, length, "header");
    const Element type = element_of(file, value_of(file, header, "descr"));
    const Shape shape = shape_of(file, value_of(file, header, "shape"));
    const std::string_view order = value_of(file, header, "fortran_order");
    if (!order.starts_with("True") && !order.starts_with("False"))
        file.fail(length_at, "fortran_order", plain_line(order.substr(0, 10)), "True or False");
    const bool by_columns = order.starts_with("True");
    file.check_size(shape.columns, shape.rows);
    const auto points = file.bytes(header_at + length, shape.columns * shape.rows * type.bytes, "points");

    SurfaceFile result;
    result.map.pitch_x = result.map.pitch_y = *scale.pitch;
    Grid<double>& heights = result.map.height;
    heights = Grid<double>(static_cast<int>(shape.columns), static_cast<int>(shape.rows));
    const ValueAt value = reader_of(type);
    for (std::size_t line = 0; line < shape.rows; ++line)
        for (std::size_t column = 0; column < shape.columns; ++column) {
            const std::size_t index = by_columns ? column * shape.rows + line : line * shape.columns + column;
            heights(static_cast<int>(column), static_cast<int>(shape.rows - 1 - line)) =
                measured_height(value(points, index, type.swapped), *scale.unit);
        }
    return result;
}

namespace {

// The bytes before the first value. type: NumPy's name; shape: numbers with commas.
std::string header_bytes(const char* type, const std::string& shape) {
    std::string header = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, shape);
    const std::size_t fixed = length_at + sizeof(std::uint16_t);
    header.resize((fixed + header.size()) / npy_alignment * npy_alignment + npy_alignment - fixed, ' ');
    header.back() = '\n';
    std::string bytes(npy_magic);
    bytes += std::string("\x01\0", 2);
    append(bytes, static_cast<std::uint16_t>(header.size()));
    return bytes + header;
}

} // namespace

std::string npy_bytes(const HeightMap& map) {
    std::string bytes = header_bytes("<f8", fmt::format("{}, {}", map.rows(), map.columns()));
    bytes.reserve(bytes.size() + map.height.values.size() * sizeof(double));
    for (int row = map.rows() - 1; row >= 0; --row)
        for (int column = 0; column < map.columns(); ++column) {
            const double mm = map.height(column, row);
            append(bytes, std::isfinite(mm) ? mm / mm_per_um : std::numeric_limits<double>::quiet_NaN());
        }
    return bytes;
}

std::string npy_bytes(std::span<const float> values, const std::vector<std::size_t>& shape) {
    std::string text;
    for (const std::size_t length : shape) {
        text += fmt::format("{}, ", length);
    }
    std::string bytes = header_bytes("<f4", text);
    bytes.reserve(bytes.size() + values.size_bytes());
    for (const float value : values) {
        append(bytes, value);
    }
    return bytes;
}

} // namespace vkfv::surface
