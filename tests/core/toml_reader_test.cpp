#include "core/toml/toml_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

namespace vkfv {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// The message of the InputError that `action` throws.
template <class Action>
std::string message_of(Action action) {
    try {
        action();
    } catch (const InputError& error) {
        return error.what();
    }
    return "(nothing was thrown)";
}

TomlTable table_of(const char* text) {
    return TomlTable::parse(text, "lens.toml");
}

TEST(TomlReader, GivesTypedValues) {
    const auto root = table_of("number = 2.5\n"
                               "integer = 3\n"
                               "large = 1e9\n"
                               "flag = true\n"
                               "name = \"10x\"\n"
                               "list = [1, 2.5]\n"
                               "[part]\n"
                               "g = -0.5\n"
                               "[[surface]]\n"
                               "curvature = 0.1\n"
                               "[[surface]]\n"
                               "curvature = 0.2\n");
    EXPECT_EQ(root.number("number"), 2.5);
    EXPECT_EQ(root.number("integer"), 3.0);
    EXPECT_EQ(root.integer("integer", 1, 3), 3);
    EXPECT_EQ(root.integer("large", 1, 2'000'000'000), 1'000'000'000);
    EXPECT_TRUE(root.boolean("flag"));
    EXPECT_EQ(root.string("name"), "10x");
    EXPECT_EQ(root.choice("name", {"5x", "10x"}), "10x");
    EXPECT_THAT(root.numbers("list"), testing::ElementsAre(1, 2.5));
    EXPECT_EQ(root.table("part").number("g", NumberRange::within(-1, 1)), -0.5);
    const auto surfaces = root.tables("surface");
    ASSERT_EQ(surfaces.size(), 2u);
    EXPECT_EQ(surfaces[0].number("curvature"), 0.1);
    EXPECT_EQ(surfaces[1].number("curvature"), 0.2);
    EXPECT_EQ(surfaces[1].path(), "surface[1]");
    EXPECT_FALSE(root.optional_number("absent"));
    EXPECT_FALSE(root.optional_table("absent"));
    EXPECT_EQ(root.table_or_empty("absent").path(), "absent");
    EXPECT_THROW((void)root.table_or_empty("absent").number("x"), InputError);
    EXPECT_NO_THROW(root.reject_unknown_keys());
}

TEST(TomlReader, KnowsWhereEveryValueStands) {
    const auto root = table_of("a = 1\n\n[part]\n  g = 2\n");
    const auto part = root.table("part");
    EXPECT_EQ(root.where("a").to_string(), "lens.toml:1:5");
    EXPECT_EQ(part.where().to_string(), "lens.toml:3:1");
    EXPECT_EQ(part.where("g").to_string(), "lens.toml:4:7");
}

TEST(TomlReader, NamesPlaceKeyValueExpectationAndRemedy) {
    const auto root = table_of("[material]\ng = 1.5\nscatter = \"lambert\"\nradii = [1, \"two\"]\nfine = 0.5\n");
    const auto material = root.table("material");
    EXPECT_THAT(message_of([&] { (void)material.number("g", NumberRange::within(-1, 1)); }),
                AllOf(HasSubstr("lens.toml:2:5: material.g = 1.5: expected a finite number in [-1, 1]"),
                      HasSubstr("Correct material.g")));
    EXPECT_THAT(message_of([&] {
                    (void)material.choice("scatter", {"lambertian", "mirror"});
                }),
                AllOf(HasSubstr("lens.toml:3:11"), HasSubstr("\"lambertian\" or \"mirror\""),
                      HasSubstr("Did you mean \"lambertian\"?")));
    EXPECT_THAT(message_of([&] { (void)material.numbers("radii"); }),
                AllOf(HasSubstr("lens.toml:4:13"), HasSubstr("material.radii[1]"), HasSubstr("two")));
    EXPECT_THAT(message_of([&] { (void)material.number("absent", NumberRange::positive()); }),
                AllOf(HasSubstr("lens.toml:1:1"), HasSubstr("material.absent"),
                      HasSubstr("expected a finite number > 0, found nothing"), HasSubstr("Add absent to [material]")));
    EXPECT_THAT(message_of([&] { (void)material.integer("fine", 1, 9); }), HasSubstr("an integer in [1, 9]"));
    EXPECT_THAT(message_of([&] { (void)material.string("g"); }), HasSubstr("expected a string"));
    EXPECT_THAT(message_of([&] { (void)material.table("g"); }), HasSubstr("Write [material.g]"));
    EXPECT_THAT(message_of([&] { (void)root.tables("material"); }), HasSubstr("Write [[material]]"));
}

TEST(TomlReader, RangesExcludeWhatTheySay) {
    EXPECT_FALSE(NumberRange::positive().contains(0));
    EXPECT_TRUE(NumberRange::at_least(0).contains(0));
    EXPECT_FALSE(NumberRange::between(0, 1).contains(1));
    EXPECT_TRUE(NumberRange::within(0, 1).contains(1));
    EXPECT_FALSE(NumberRange::finite().contains(std::numeric_limits<double>::quiet_NaN()));
    EXPECT_FALSE(NumberRange::finite().contains(std::numeric_limits<double>::infinity()));
    EXPECT_EQ(NumberRange::between(0, 1).to_string(), "in (0, 1)");
}

TEST(TomlReader, LengthsAreThoseThatSomethingHas) {
    EXPECT_EQ(vkfv::expected_length("a_mm", 1e-10),
              "a length that can be, 0 or from 1e-09 (1 pm) to 1e+09 mm (1000 km)");
    EXPECT_THAT(vkfv::expected_length("b_um", 2e12).value_or(""), HasSubstr("from 1e-06 (1 pm) to 1e+12 um"));
    EXPECT_TRUE(vkfv::expected_length("c_um", -1e-7));
    EXPECT_FALSE(vkfv::expected_length("change_per_um", -1e-7)); // a rate by a length is none
    const std::vector<std::pair<const char*, double>> possible = {{"d_mm", 0.0}, {"e_mm", -1e-9}, {"f_um", 1e12},
                                                                  {"g", 1e-300}, {"h_um", 1e-6},  {"i_W", 1e-12}};
    for (const auto& [key, value] : possible) {
        EXPECT_FALSE(vkfv::expected_length(key, value)) << key;
    }
}

TEST(TomlReader, NonFiniteNumbersAreNotNumbers) {
    const auto root = table_of("a = nan\nb = inf\n");
    EXPECT_THAT(message_of([&] { (void)root.number("a"); }), HasSubstr("a = nan"));
    EXPECT_THAT(message_of([&] { (void)root.number("b"); }), HasSubstr("b = inf"));
}

TEST(TomlReader, SuggestsTheNearestKnownKey) {
    const auto root = table_of("[detector]\npixles = 64\n");
    const auto detector = root.table("detector");
    (void)detector.optional_integer("pixels", 1, 16384);
    (void)detector.optional_number("size_mm");
    EXPECT_THAT(message_of([&] { root.reject_unknown_keys(); }),
                AllOf(HasSubstr("lens.toml:2:1: detector.pixles = 64"), HasSubstr("Did you mean \"pixels\"?")));
    EXPECT_EQ(nearest_word("raduis_mm", {"radius_mm", "flux_W"}), "radius_mm");
    EXPECT_EQ(nearest_word("zebra", {"radius_mm", "flux_W"}), std::nullopt);
    EXPECT_EQ(nearest_word("gg", {"scatter", "g"}), "g");
    EXPECT_EQ(nearest_word("q", {"scatter", "g"}), std::nullopt);
}

TEST(TomlReader, ParseErrorsHavePlaces) {
    EXPECT_THAT(message_of([] { (void)table_of("a = 1\nb = \n"); }), HasSubstr("lens.toml:2:"));
    EXPECT_THAT(message_of([] { (void)table_of("a = 1\na = 2\n"); }), HasSubstr("lens.toml:2:"));
    EXPECT_THAT(message_of([] { (void)TomlTable::open("no/such/file.toml"); }),
                AllOf(HasSubstr("no/such/file.toml"), HasSubstr("no such file")));
    EXPECT_THAT(message_of([] { (void)TomlTable::open(testing::TempDir()); }), HasSubstr("a directory"));
}

TEST(TomlReader, OverridesReplaceValuesAndNameTheirOrigin) {
    const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "overridden.toml";
    std::ofstream(file) << "[trace]\nrays = 5\nseed = 1\n[specimen]\nfile = \"letter.stl\"\n";
    const auto root = TomlTable::open(file, {{"trace.rays", "1e3", "--rays"},
                                             {"specimen.file", "letter.stl", "--set"},
                                             {"detector.pixels", "many", "--set"}});
    const auto trace = root.table("trace");
    EXPECT_EQ(trace.integer("rays", 1, 100'000), 1000);
    EXPECT_EQ(trace.integer("seed", 0, 10), 1);
    // A path of an override counts from the working directory, not from the file's folder.
    EXPECT_EQ(root.table("specimen").file_path("file"), "letter.stl");
    EXPECT_THAT(message_of([&] { (void)root.table("detector").integer("pixels", 1, 9); }),
                AllOf(HasSubstr("--set: detector.pixels = "), HasSubstr("many")));
    EXPECT_EQ(TomlTable::open(file).table("specimen").file_path("file"), file.parent_path() / "letter.stl");
    EXPECT_THROW((void)TomlTable::open(file, {{"trace rays", "1", "--set"}}), InputError);
    EXPECT_THROW((void)TomlTable::open(file, {{"", "1", "--set"}}), InputError);
}

TEST(TomlReader, ListsOfPathsAreRelativeToWhereTheyWereWritten) {
    const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "paths.toml";
    std::ofstream(file) << "files = [\"a.agf\", \"/b.agf\"]\nwords = \"a.agf\"\nbad = [\"a.agf\", 1]\n";
    const auto root = TomlTable::open(file);
    EXPECT_THAT(root.optional_file_paths("files"),
                testing::ElementsAre(file.parent_path() / "a.agf", std::filesystem::path("/b.agf")));
    EXPECT_THAT(root.optional_file_paths("absent"), testing::IsEmpty());
    EXPECT_THAT(TomlTable::open(file, {{"files", "[\"a.agf\"]", "--set"}}).optional_file_paths("files"),
                testing::ElementsAre("a.agf")); // from the working directory
    EXPECT_THAT(message_of([&] { (void)root.optional_file_paths("words"); }), HasSubstr("paths.toml:2:9: words"));
    EXPECT_THAT(message_of([&] { (void)root.optional_file_paths("bad"); }), HasSubstr("bad[1]"));
}

TEST(TomlReader, QuotedTextReadsBack) {
    const std::string text = "a \"b\" \\ \t\x01 \xc3\xb6";
    EXPECT_EQ(TomlTable::parse("t = " + toml_quoted(text), "quoted").string("t"), text);
}

} // namespace
} // namespace vkfv
