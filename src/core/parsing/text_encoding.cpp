#include "core/parsing/text_encoding.hpp"

#include "core/messages/safe_text.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>

namespace vkfv {

namespace {

enum class ByteOrder { little, big };

void append_utf8(std::string& text, std::uint32_t code) {
    if (code < 0x80) {
        text += static_cast<char>(code);
        return;
    }
    const int following = code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
    constexpr std::uint32_t lead[] = {0, 0xc0, 0xe0, 0xf0};
    text += static_cast<char>(lead[following] | code >> (6 * following));
    for (int i = following - 1; i >= 0; --i) {
        text += static_cast<char>(0x80 | (code >> (6 * i) & 0x3f));
    }
}

std::string utf8_of_utf16(std::string_view bytes, ByteOrder order) {
    const auto unit = [&](std::size_t i) {
        const auto first = static_cast<unsigned char>(bytes[i]);
        const auto second = static_cast<unsigned char>(bytes[i + 1]);
        return static_cast<std::uint32_t>(order == ByteOrder::big ? first << 8 | second : second << 8 | first);
    };
    std::string text;
    text.reserve(bytes.size() / 2);
    for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
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

// The byte order of UTF-16, recognized by the NULs that Latin letters contain and other encodings do not; none for
// other text.
std::optional<ByteOrder> order_of_utf16(std::string_view bytes) {
    if (bytes.starts_with("\xff\xfe")) {
        return ByteOrder::little;
    }
    if (bytes.starts_with("\xfe\xff")) {
        return ByteOrder::big;
    }
    constexpr std::size_t looked_at = 1024, least = 4;
    const std::string_view start = bytes.substr(0, std::min(bytes.size(), looked_at) / 2 * 2);
    std::size_t nuls[2] = {0, 0}; // counts at even and odd places
    for (std::size_t i = 0; i < start.size(); ++i) {
        nuls[i % 2] += start[i] == '\0' ? 1u : 0u;
    }
    const std::size_t most = start.size() / 2 - start.size() / 8; // three quarters of the characters
    if (start.size() < least || (nuls[0] > 0) == (nuls[1] > 0) || std::max(nuls[0], nuls[1]) < most) {
        return std::nullopt;
    }
    return nuls[0] > 0 ? ByteOrder::big : ByteOrder::little;
}

std::string in_utf8(std::string_view bytes) {
    if (const auto order = order_of_utf16(bytes)) {
        const bool marked = bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff");
        return utf8_of_utf16(bytes.substr(marked ? 2 : 0), *order);
    }
    if (bytes.starts_with("\xef\xbb\xbf")) {
        bytes.remove_prefix(3);
    }
    if (is_utf8(bytes)) {
        return std::string(bytes);
    }
    std::string text;
    text.reserve(bytes.size() + bytes.size() / 8);
    for (const char byte : bytes) { // Latin-1: each byte is its code point
        append_utf8(text, static_cast<unsigned char>(byte));
    }
    return text;
}

} // namespace

bool is_utf8(std::string_view text) {
    while (!text.empty()) {
        const std::size_t bytes = first_character(text).bytes;
        if (bytes == 0) {
            return false;
        }
        text.remove_prefix(bytes);
    }
    return true;
}

std::string as_utf8(std::string_view bytes) {
    std::string text = in_utf8(bytes);
    if (text.find('\n') == std::string::npos) {
        std::ranges::replace(text, '\r', '\n');
    }
    return text;
}

} // namespace vkfv
