#include "core/messages/safe_text.hpp"

#include "core/messages/error.hpp"
#include "core/messages/json_text.hpp"
#include "core/toml/toml_document.hpp"
#include "core/toml/toml_reader.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>

namespace vkfv {
namespace {

// Text that a terminal obeys, or that no reader sees: an escape sequence, a bell, a carriage return, CSI in Latin-1's
// control characters, an override of the direction of writing, a byte that is not UTF-8, half a character at the end.
const std::string hostile = "a\x1b[31m\x07\r\xc2\x9b\xe2\x80\xae\xff z\xc3";
const std::string harmless = "a\\x1b[31m\\x07\\x0d\\u{009b}\\u{202e}\\xff z\\xc3";

TEST(SafeText, EscapesWhatATerminalObeys) {
    EXPECT_EQ(safe_text(hostile), harmless);
    EXPECT_EQ(safe_line(hostile), harmless);
    EXPECT_EQ(safe_text(harmless), harmless);
    EXPECT_EQ(safe_text(std::string("NUL \0", 5)), "NUL \\x00");
}

TEST(SafeText, KeepsLettersOfAllLanguages) {
    const std::string letters = "\xc3\xbc \xc2\xb5m \xe6\xb5\x8b \xf0\x9d\x9c\x86";
    EXPECT_EQ(safe_line(letters), letters);
}

TEST(SafeText, BytesThatAreNoUtf8AreEscapedOneByOne) {
    for (const std::string bytes :
         {"\xc0\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xf8\x88\x80\x80\x80", "\xe2\x28\xa1"}) {
        EXPECT_EQ(first_character(bytes).bytes, 0u);
        EXPECT_TRUE(safe_text(bytes).starts_with("\\x"));
    }
}

TEST(SafeText, ALineStaysALine) {
    EXPECT_EQ(safe_text("two\nlines\tand a tab"), "two\nlines\tand a tab");
    EXPECT_EQ(safe_line("two\nlines\tand a tab"), "two\\x0alines\\x09and a tab");
}

TEST(SafeText, ACellOfCsvIsQuotedWhereItMustBe) {
    EXPECT_EQ(csv_cell("plain"), "plain");
    EXPECT_EQ(csv_cell("one, two"), "\"one, two\"");
    EXPECT_EQ(csv_cell("5\" disc"), "\"5\"\" disc\"");
    EXPECT_EQ(csv_cell("two\nlines"), "two\\x0alines");
}

TEST(SafeText, JsonIsValidWhateverItsStringsHold) {
    const nlohmann::ordered_json json = {{"file", hostile}, {"delete", "\x7f"}, {"letters", "\xc2\xb5m"}};
    const std::string text = json_text(json, JsonLayout::one_line);
    EXPECT_EQ(text, R"({"file":"a\u001b[31m\u0007\r\u009b\u202e)"
                    "\xef\xbf\xbd z\xef\xbf\xbd"
                    R"(","delete":"\u007f","letters":")"
                    "\xc2\xb5m\"}");
    EXPECT_EQ(safe_text(text), text);
    EXPECT_EQ(nlohmann::ordered_json::parse(text)["delete"], "\x7f");
}

TEST(SafeText, TomlIsValidWhateverItsStringsHold) {
    const auto table = TomlTable::parse("key = " + toml_quoted(hostile + "\"\\"), "c.toml");
    EXPECT_EQ(table.string("key"), "a\x1b[31m\x07\r\xc2\x9b\xe2\x80\xae\xef\xbf\xbd z\xef\xbf\xbd\"\\");
    EXPECT_EQ(safe_text(toml_quoted(hostile)), toml_quoted(hostile));
}

TEST(SafeText, AnErrorNamesItsFileAndItsFindInOneLine) {
    const InputError error({.where = {.file = "a\nb.toml", .line = 3},
                            .key = "k\x1b",
                            .found = "x\ny",
                            .expected = "a number",
                            .remedy = "Correct it."});
    EXPECT_STREQ(error.what(), "a\\x0ab.toml:3: k\\x1b = x\\x0ay: expected a number. Correct it.");
}

} // namespace
} // namespace vkfv
