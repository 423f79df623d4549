#include "core/toml/toml_tables.hpp"

#include <gtest/gtest.h>

#include <string>

namespace vkfv {
namespace {

const std::string text = "a = 1\n[b]\nc = 2\ncc = 3\n[b.e]\nc = 4\n[[b.f]]\nc = 5\n[bb]\nc = 6\n";

TEST(WithoutEntries, ATableGoesWithTheTablesBelowIt) {
    EXPECT_EQ(without_entries(text, {"b"}), "a = 1\n[bb]\nc = 6\n");
    EXPECT_EQ(without_entries(text, {"b.e", "bb"}), "a = 1\n[b]\nc = 2\ncc = 3\n[[b.f]]\nc = 5\n");
}

TEST(WithoutEntries, AKeyGoesAlone) {
    EXPECT_EQ(without_entries(text, {"b.c", "a"}), "[b]\ncc = 3\n[b.e]\nc = 4\n[[b.f]]\nc = 5\n[bb]\nc = 6\n");
    EXPECT_EQ(without_entries(text, {"c"}), text);
}

} // namespace
} // namespace vkfv
