#include "core/parsing/text_encoding.hpp"

#include <gtest/gtest.h>

#include <string>

namespace vkfv {
namespace {

// The text "ü=µ𝜆" as UTF-16.
std::string utf16(bool big_endian, bool marked) {
    std::string bytes;
    const auto append = [&](unsigned unit) {
        const char high = static_cast<char>(unit >> 8), low = static_cast<char>(unit & 0xff);
        bytes += big_endian ? std::string{high, low} : std::string{low, high};
    };
    if (marked) {
        append(0xfeff);
    }
    for (const unsigned unit : {0xfcu, 0x3du, 0xb5u, 0xd835u, 0xdf06u}) {
        append(unit);
    }
    for (const char character : std::string(" and more text of plain letters")) {
        append(static_cast<unsigned char>(character));
    }
    return bytes;
}

TEST(TextEncoding, EveryEncodingIsTheSameText) {
    const std::string expected = "\xc3\xbc=\xc2\xb5\xf0\x9d\x9c\x86 and more text of plain letters";
    EXPECT_EQ(as_utf8(expected), expected);
    EXPECT_EQ(as_utf8("\xef\xbb\xbf" + expected), expected);
    for (const bool big_endian : {false, true}) {
        for (const bool marked : {false, true}) {
            EXPECT_EQ(as_utf8(utf16(big_endian, marked)), expected) << big_endian << marked;
        }
    }
}

TEST(TextEncoding, WhatIsNoUtf8IsLatin1) {
    EXPECT_EQ(as_utf8("gr\xfc\xdf"), "gr\xc3\xbc\xc3\x9f");
    // Overlong forms, surrogates, code points beyond the last one and sequences cut off are no UTF-8.
    for (const std::string bytes : {"\xc0\xaf", "\xe0\x80\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xf5\x80\x80\x80",
                                    "\x80", "\xc3", "\xc3x"}) {
        const std::string text = as_utf8(bytes);
        EXPECT_NE(text, bytes);
        EXPECT_EQ(as_utf8(text), text); // well-formed now
    }
}

TEST(TextEncoding, HalfCharactersDoNoHarm) {
    using namespace std::string_literals;
    EXPECT_EQ(as_utf8("\xff\xfe\x35\xd8"s), "?");
    EXPECT_EQ(as_utf8("\xff\xfe\x35\xd8x\0"s), "?x");
    EXPECT_EQ(as_utf8("\xff\xfe\x06\xdf"s), "?");
    EXPECT_EQ(as_utf8("\xff\xfe"
                      "a\0b"s),
              "a");
    EXPECT_EQ(as_utf8(""), "");
    EXPECT_EQ(as_utf8("a\0b"s), "a\0b"s); // NULs among letters are no UTF-16
}

} // namespace
} // namespace vkfv
