#include "images/tiff_stack.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <utility>

namespace vkfv::images {

namespace {

enum class FieldType : std::uint16_t {
    byte = 1,
    ascii = 2,
    two_bytes = 3,
    four_bytes = 4,
    ratio = 5,
    eight_bytes = 16
};

enum class Tag : std::uint16_t {
    width = 256,
    height = 257,
    bits_per_sample = 258,
    compression = 259,
    photometric = 262,
    description = 270,
    strip_offset = 273,
    orientation = 274,
    samples_per_pixel = 277,
    rows_per_strip = 278,
    strip_bytes = 279,
    x_resolution = 282,
    y_resolution = 283,
    resolution_unit = 296,
    software = 305,
    sample_format = 339,
    imagej_metadata_bytes = 50838,
    imagej_metadata = 50839,
};

template <class Number>
void append(std::string& bytes, Number number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

struct Field {
    Tag tag;
    FieldType type;
    std::uint64_t count;
    std::string value;
};

template <class Number>
Field field(Tag tag, FieldType type, Number number) {
    Field result{.tag = tag, .type = type, .count = 1, .value = {}};
    append(result.value, number);
    return result;
}

Field two_bytes(Tag tag, int number) {
    return field(tag, FieldType::two_bytes, static_cast<std::uint16_t>(number));
}

Field four_bytes(Tag tag, std::uint64_t number) {
    return field(tag, FieldType::four_bytes, static_cast<std::uint32_t>(number));
}

Field text(Tag tag, const std::string& ascii) {
    return {.tag = tag,
            .type = FieldType::ascii,
            .count = ascii.size() + 1,
            .value = std::string(ascii.c_str(), ascii.size() + 1)};
}

// A ratio of two 32-bit numbers that approximates a number as closely as possible.
Field ratio(Tag tag, double number) {
    constexpr double most = std::numeric_limits<std::uint32_t>::max();
    const double denominator = std::clamp(std::floor(most / number), 1.0, most);
    Field result = four_bytes(tag, static_cast<std::uint64_t>(std::clamp(std::round(number * denominator), 1.0, most)));
    result.type = FieldType::ratio;
    append(result.value, static_cast<std::uint32_t>(denominator));
    return result;
}

// ImageJ's labels of slices: a header that lists the contents, followed by the texts in UTF-16; the other tag has the
// length of each. Their words have the byte order of the file.
std::pair<Field, Field> labels_of(const std::vector<std::string>& pages) {
    const auto word = [](const char* letters) {
        std::uint32_t value = 0;
        for (int i = 0; i < 4; ++i) {
            value = value << 8 | static_cast<unsigned char>(letters[i]);
        }
        return value;
    };
    Field lengths{
        .tag = Tag::imagej_metadata_bytes, .type = FieldType::four_bytes, .count = pages.size() + 1, .value = {}};
    Field labels{.tag = Tag::imagej_metadata, .type = FieldType::byte, .count = 0, .value = {}};
    append(labels.value, word("IJIJ"));
    append(labels.value, word("labl"));
    append(labels.value, static_cast<std::uint32_t>(pages.size()));
    append(lengths.value, static_cast<std::uint32_t>(labels.value.size()));
    for (const std::string& page : pages) {
        append(lengths.value, static_cast<std::uint32_t>(2 * page.size()));
        for (const char letter : page) {
            append(labels.value, static_cast<std::uint16_t>(static_cast<unsigned char>(letter)));
        }
    }
    labels.count = labels.value.size();
    return {std::move(lengths), std::move(labels)};
}

std::string imagej_text(const TiffStack& stack) {
    const std::size_t count = stack.pages.size();
    std::string lines = fmt::format("ImageJ=1.53t\nimages={}\nslices={}\nunit=um\n", count, count);
    if (stack.step != 0) {
        // The slice of height 0, counted from the first slice, is the origin.
        lines += fmt::format("spacing={:.12g}\nzorigin={:.12g}\n", stack.step, -stack.first / stack.step + 0.0);
    }
    return lines + "loop=false\n" + stack.notes;
}

// The size of numbers in directories: 4 bytes, or 8 in a BigTIFF.
struct Format {
    bool big;

    std::size_t word() const { return big ? 8 : 4; }
    std::size_t entry_bytes() const { return 4 + 2 * word(); }
    std::size_t header_bytes() const { return big ? 16 : 8; }
    void append_word(std::string& bytes, std::uint64_t number) const {
        big ? append(bytes, number) : append(bytes, static_cast<std::uint32_t>(number));
    }
    void append_count(std::string& bytes, std::size_t fields) const {
        big ? append(bytes, std::uint64_t{fields}) : append(bytes, static_cast<std::uint16_t>(fields));
    }
    std::size_t count_bytes() const { return big ? 8 : 2; }
};

constexpr std::size_t alignment = 16; // alignment of data outside a directory

std::size_t aligned(std::size_t size) {
    return (size + alignment - 1) / alignment * alignment;
}

std::vector<Field> fields_of(const TiffStack& stack, std::size_t page, std::uint64_t value_bytes, std::uint64_t place,
                             const Format& format) {
    const int bits = stack.bits == PixelBits::float32 ? 32 : stack.bits == PixelBits::uint16 ? 16 : 8;
    const auto word = [&](Tag tag, std::uint64_t number) {
        return format.big ? field(tag, FieldType::eight_bytes, number) : four_bytes(tag, number);
    };
    constexpr int none = 1, unsigned_integer = 1, floating = 3, black_is_zero = 1, top_left = 1;
    std::vector<Field> fields = {four_bytes(Tag::width, static_cast<std::uint64_t>(stack.columns)),
                                 four_bytes(Tag::height, static_cast<std::uint64_t>(stack.rows)),
                                 two_bytes(Tag::bits_per_sample, bits),
                                 two_bytes(Tag::compression, none),
                                 two_bytes(Tag::photometric, black_is_zero),
                                 text(Tag::description, page == 0 ? imagej_text(stack) : stack.pages[page]),
                                 word(Tag::strip_offset, place),
                                 two_bytes(Tag::orientation, top_left),
                                 two_bytes(Tag::samples_per_pixel, 1),
                                 four_bytes(Tag::rows_per_strip, static_cast<std::uint64_t>(stack.rows)),
                                 word(Tag::strip_bytes, value_bytes),
                                 ratio(Tag::x_resolution, 1 / stack.pitch),
                                 ratio(Tag::y_resolution, 1 / stack.pitch),
                                 two_bytes(Tag::resolution_unit, none), // the unit is in ImageJ's text
                                 text(Tag::software, "vkfv"),
                                 two_bytes(Tag::sample_format, bits == 32 ? floating : unsigned_integer)};
    if (page == 0) {
        auto [lengths, labels] = labels_of(stack.pages);
        fields.push_back(std::move(lengths));
        fields.push_back(std::move(labels));
    }
    return fields;
}

std::size_t directory_bytes(const std::vector<Field>& fields, const Format& format) {
    std::size_t size = aligned(format.count_bytes() + fields.size() * format.entry_bytes() + format.word());
    for (const Field& each : fields) {
        size += each.value.size() > format.word() ? aligned(each.value.size()) : 0;
    }
    return size;
}

// The bytes of a directory at the offset `place`, with its values behind it.
std::string directory(const std::vector<Field>& fields, std::uint64_t place, bool last, const Format& format) {
    std::string entries;
    std::string outside;
    const std::size_t table = aligned(format.count_bytes() + fields.size() * format.entry_bytes() + format.word());
    format.append_count(entries, fields.size());
    for (const Field& each : fields) {
        append(entries, static_cast<std::uint16_t>(each.tag));
        append(entries, static_cast<std::uint16_t>(each.type));
        format.append_word(entries, each.count);
        if (each.value.size() > format.word()) {
            format.append_word(entries, place + table + outside.size());
            outside += each.value;
            outside.resize(aligned(outside.size()));
        } else {
            std::string value = each.value;
            value.resize(format.word());
            entries += value;
        }
    }
    format.append_word(entries, last ? 0 : place + table + outside.size());
    entries.resize(table);
    return entries + outside;
}

} // namespace

std::string tiff_stack_head(const TiffStack& stack) {
    const std::size_t pages = stack.pages.size();
    if (pages == 0 || stack.columns < 1 || stack.rows < 1 || !(stack.pitch > 0)) {
        throw std::invalid_argument("a stack without pixels");
    }
    const std::uint64_t bytes_a_value = stack.bits == PixelBits::float32 ? 4 : stack.bits == PixelBits::uint16 ? 2 : 1;
    const std::uint64_t value_bytes =
        static_cast<std::uint64_t>(stack.columns) * static_cast<std::uint64_t>(stack.rows) * bytes_a_value;
    const auto head_bytes = [&](const Format& format) {
        std::size_t size = aligned(format.header_bytes());
        for (std::size_t page = 0; page < pages; ++page) {
            size += directory_bytes(fields_of(stack, page, value_bytes, 0, format), format);
        }
        return size;
    };
    Format format{.big = false};
    std::size_t size = head_bytes(format);
    if (size + pages * value_bytes > std::numeric_limits<std::uint32_t>::max()) {
        format.big = true;
        size = head_bytes(format);
    }
    std::string head(std::endian::native == std::endian::little ? "II" : "MM");
    append(head, static_cast<std::uint16_t>(format.big ? 43 : 42));
    if (format.big) {
        append(head, std::uint16_t{8}); // bytes of an offset
        append(head, std::uint16_t{0});
    }
    format.append_word(head, aligned(format.header_bytes()));
    head.resize(aligned(head.size()));
    head.reserve(size);
    for (std::size_t page = 0; page < pages; ++page) {
        const auto fields = fields_of(stack, page, value_bytes, size + page * value_bytes, format);
        head += directory(fields, head.size(), page + 1 == pages, format);
    }
    return head;
}

} // namespace vkfv::images
