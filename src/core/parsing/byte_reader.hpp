// Reads numbers and texts at offsets of a file's bytes; reading beyond the file is an InputError.
#pragma once

#include "core/messages/error.hpp"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace vkfv {

static_assert(std::endian::native == std::endian::little, "the formats are little-endian, and so is the memory");

// A larger number of points is taken for a damaged header (2 GiB of heights).
inline constexpr std::uint64_t largest_point_count = std::uint64_t{1} << 28;

// The limits of packed points, which may be a thousand times smaller than unpacked. Points of a measurement are not
// packed that well: if unpacked to more than freely_packed_bytes, the file must hold at least a 64th of them; others
// are made to exhaust the memory.
inline constexpr std::uint64_t freely_packed_bytes = std::uint64_t{1} << 28; // 256 MiB
inline constexpr std::uint64_t largest_packing = 64;

// The finite number in `text`, which may have blanks around it and a plus sign; none for any other text.
template <class Value>
std::optional<Value> number_in(std::string_view text) {
    const auto begin = text.find_first_not_of(" \t\r\n");
    if (begin == std::string_view::npos)
        return std::nullopt;
    text = text.substr(begin, text.find_last_not_of(" \t\r\n") + 1 - begin);
    if (text.starts_with('+'))
        text.remove_prefix(1);
    Value value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    bool good = error == std::errc() && end == text.data() + text.size();
    if constexpr (std::is_floating_point_v<Value>)
        good = good && std::isfinite(value);
    return good ? std::optional(value) : std::nullopt;
}

class ByteReader {
  public:
    ByteReader(std::string_view bytes, std::filesystem::path file) : bytes_(bytes), file_(std::move(file)) {}

    std::size_t size() const { return bytes_.size(); }
    const std::filesystem::path& file() const { return file_; }

    [[noreturn]] void fail(std::optional<std::uint64_t> offset, std::string key, std::string found,
                           std::string expected, std::string remedy = "Export or copy the file anew.") const {
        throw InputError({.where = {.file = file_, .line = 0, .column = 0, .byte_offset = offset},
                          .key = std::move(key),
                          .found = std::move(found),
                          .expected = std::move(expected),
                          .remedy = std::move(remedy)});
    }

    std::string_view bytes(std::uint64_t offset, std::uint64_t length, const char* what) const {
        if (offset > bytes_.size() || length > bytes_.size() - offset)
            fail(offset, what, fmt::format("a file of {} bytes", bytes_.size()),
                 fmt::format("{} bytes from here on", length));
        return bytes_.substr(offset, length);
    }
    template <class Value>
    Value at(std::uint64_t offset, const char* what) const {
        Value value;
        std::memcpy(&value, bytes(offset, sizeof value, what).data(), sizeof value);
        return value;
    }

    // Checks sizes before memory is allocated for them.
    void check_size(std::uint64_t columns, std::uint64_t rows, std::optional<std::uint64_t> offset = {}) const {
        if (columns < 1 || rows < 1 || columns > largest_point_count || rows > largest_point_count / columns)
            fail(offset, "size", fmt::format("{} x {} points", columns, rows),
                 fmt::format("at least one point and at most {}", largest_point_count));
    }
    // Checks the unpacked size (bytes of memory) of points that are packed in the file.
    void check_packing(std::uint64_t unpacked, const std::string& what) const {
        if (unpacked > freely_packed_bytes && unpacked / largest_packing > size())
            fail({}, what, fmt::format("{} bytes of heights in a file of {}", unpacked, size()),
                 fmt::format("beyond {} bytes at most {} times as many as the file has", freely_packed_bytes,
                             largest_packing),
                 "Export a part of the surface, or the whole without packing if it is really so large.");
    }
    // Checks that a spacing, in any unit, is positive and finite.
    void check_spacing(double spacing, const char* key, std::optional<std::uint64_t> offset = {}) const {
        if (!(std::isfinite(spacing) && spacing > 0))
            fail(offset, key, fmt::format("{}", spacing), "a positive spacing");
    }

  private:
    std::string_view bytes_;
    std::filesystem::path file_;
};

// The value of a raw array's index-th element.
template <class Value>
Value element(std::string_view array, std::size_t index) {
    Value value;
    std::memcpy(&value, array.data() + index * sizeof value, sizeof value);
    return value;
}

template <class Value>
void append(std::string& bytes, const Value& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

} // namespace vkfv
