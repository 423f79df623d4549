// Text that nests without bound ends as an InputError, before anything recurses over it.
#include "core/toml/toml_nesting.hpp"
#include "core/toml/toml_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vkfv {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string repeated(const std::string& piece, int times) {
    std::string text;
    for (int i = 0; i < times; ++i) {
        text += piece;
    }
    return text;
}

std::string message_of(const std::string& text, const std::vector<TomlOverride>& overrides = {}) {
    try {
        (void)TomlTable::parse(text, "c.toml", overrides);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

constexpr int many = 50'000;

TEST(TomlNesting, IsBoundedWithPlaceAndRemedy) {
    const struct {
        const char* name;
        std::string text;
        const char* place;
    } rows[] = {
        {"a table's name", "x = 1\n[" + repeated("a.", many) + "a]\n", "c.toml:2:129"},
        {"an array's name", "[[" + repeated("a.", many) + "a]]\n", "c.toml:1:128"},
        {"quoted names", "[" + repeated("\"a\".", many) + "a]\n", "c.toml:1:257"},
        {"letters of two bytes", "[" + repeated("\"\xc3\xa9\".", many) + "a]\n", "c.toml:1:257"},
        {"a key", repeated("a.", many) + "a = 1\n", "c.toml:1:128"},
        {"a key with spaces", repeated("a . ", many) + "a = 1\n", "c.toml:1:255"},
        {"a key of a deep table", "[" + repeated("a.", 40) + "a]\n" + repeated("b.", 40) + "b = 1\n", "c.toml:2:46"},
        {"arrays", "a = " + repeated("[", many) + repeated("]", many) + "\n", "c.toml:1:68"},
        {"arrays over lines", "a = " + repeated("[\n", many) + repeated("]", many) + "\n", "c.toml:64:1"},
        {"inline tables", "a = " + repeated("{a=", many) + "1" + repeated("}", many) + "\n", "c.toml:1:194"},
        {"keys of an inline table", "a = { x = 1, " + repeated("a.", many) + "a = 1 }\n", "c.toml:1:139"},
        {"without an end", "a = " + repeated("[", many), "c.toml:1:68"},
        {"behind strings", "a = \"\\\"[\"\nb = '''\n[[ '' \\'''\nc = \"\"\"\\\n\"\"\"\"\"\nd = " + repeated("[", many),
         "c.toml:6:68"},
    };
    for (const auto& row : rows) {
        EXPECT_THAT(message_of(row.text),
                    AllOf(HasSubstr(std::string(row.place) + ": "), HasSubstr("nested at most 64 deep"),
                          HasSubstr("Shorten the dotted name")))
            << row.name;
    }
}

TEST(TomlNesting, OverridesAreBoundedToo) {
    EXPECT_THAT(message_of("", {{repeated("a.", many) + "a", "1", "--set"}}),
                AllOf(HasSubstr("--set: "), HasSubstr("nested at most 64 deep")));
    EXPECT_THAT(message_of("", {{"a", repeated("[", many) + repeated("]", many), "--set"}}),
                AllOf(HasSubstr("--set: "), HasSubstr("nested at most 64 deep")));
    EXPECT_EQ(message_of("", {{"a", "\"" + repeated("[", many) + "\"", "--set"}}), "");
}

TEST(TomlNesting, WhatIsNotNestedIsRead) {
    for (const std::string& text : {
             "a = \"" + repeated("[", many) + "\"\n",
             "a = '" + repeated("{a.", many) + "'\n",
             "a = \"\"\"\n" + repeated("[[\"\n", many) + "\\\"\"\" \"\"\"\n",
             "a = '''" + repeated("a.''[", many) + "'''\n",
             "# " + repeated("[", many) + "\na = 1 # " + repeated("a.", many) + "\n",
             repeated("[[a]]\nb.c = [{ d = [1.5, 2.5] }, { d = 1979-05-27T07:32:00.5Z }]\n", 1000),
             "a = [" + repeated("1.25,", many) + "]\n",
             "a = [" + repeated("[1],", many) + "]\n",
             "\"" + repeated(".", many) + "\" = 1\n",
             "[" + repeated("a.", deepest_toml_nesting - 2) + "a]\nb = 1\n",
             "a = " + repeated("[", deepest_toml_nesting - 1) + repeated("]", deepest_toml_nesting - 1) + "\n",
         }) {
        EXPECT_EQ(message_of(text), "") << text.substr(0, 60);
    }
}

} // namespace
} // namespace vkfv
