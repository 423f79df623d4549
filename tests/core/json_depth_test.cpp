// Deep JSON is refused where it gets too deep, before a reader sees it.
#include "core/parsing/json_depth.hpp"

#include "core/messages/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace vkfv {
namespace {

using testing::HasSubstr;

std::string message_of(const std::string& text, std::optional<std::uint64_t> first_byte = {}) {
    try {
        check_json_depth(text, "a.json", first_byte);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

TEST(JsonDepth, IsBoundedWithPlaceAndRemedy) {
    const std::string deepest(most_json_depth, '['), brackets = "{\n " + deepest;
    EXPECT_EQ(message_of(deepest), "no error");
    EXPECT_THAT(message_of(brackets),
                HasSubstr("a.json:2:101: JSON = brackets nested 101 deep: expected at most 100 levels"));
    EXPECT_THAT(message_of(brackets, 20), HasSubstr("a.json@122: JSON"));
    EXPECT_THAT(message_of(brackets), HasSubstr("Remove what is nested so deep"));
    // Values side by side are not deep, and neither are brackets in strings.
    std::string beside;
    for (int k = 0; k < 1000; ++k) {
        beside += "[{}],";
    }
    EXPECT_EQ(message_of(beside), "no error");
    EXPECT_EQ(message_of("\"\\\\\\\"" + std::string(1000, '[') + "\"" + deepest), "no error");
}

TEST(TextPlace, CountsLinesAndColumnsFromOne) {
    const std::string text = "ab\ncd\n\nx";
    EXPECT_EQ(place_in(text, 0).line, 1);
    EXPECT_EQ(place_in(text, 4).line, 2);
    EXPECT_EQ(place_in(text, 4).column, 2);
    EXPECT_EQ(place_in(text, 7).line, 4);
    EXPECT_EQ(place_in(text, 100).column, 2);
}

} // namespace
} // namespace vkfv
