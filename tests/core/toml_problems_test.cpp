// Several problems at once are each told once, in the order of places, and none that another one caused.
#include "core/toml/toml_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vkfv {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

// A reader of two tables and a list.
void read(const TomlTable& root) {
    root.collect_problems();
    root.attempt("scan", [&] {
        const auto scan = root.table("scan");
        const double start = scan.number("z_start_um");
        const double stop = scan.number("z_stop_um");
        (void)scan.number("z_step_um", NumberRange::positive());
        if (stop < start) {
            scan.fail("z_stop_um", "a number above z_start_um", "Exchange them.");
        }
        (void)scan.optional_boolean("behind");
    });
    root.attempt("tube_lens", [&] {
        const auto lens = root.table("tube_lens");
        const auto kind = lens.choice("kind", {"ideal", "prescription"});
        lens.require("kind");
        (void)lens.number(kind == "ideal" ? "focal_length_mm" : "distance_mm");
    });
    for (const auto& one : root.optional_tables("line")) {
        (void)one.number("wavelength_um", NumberRange::within(0.1, 100));
        (void)one.optional_numbers("more_um", NumberRange::within(0.1, 100));
    }
    root.reject_unknown_keys();
}

std::vector<InputProblem> problems_of(const std::string& text, const std::vector<TomlOverride>& overrides = {}) {
    try {
        read(TomlTable::parse(text, "c.toml", overrides));
    } catch (const InputError& error) {
        return error.problems();
    }
    return {};
}

std::string message_of(const std::string& text) {
    try {
        read(TomlTable::parse(text, "c.toml"));
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

const std::string scan = "[scan]\nz_start_um = 0\nz_stop_um = 9\nz_step_um = 1\n";
const std::string lens = "[tube_lens]\nkind = \"ideal\"\nfocal_length_mm = 200\n";

TEST(TomlProblems, WhatIsRightIsRead) {
    EXPECT_TRUE(problems_of(scan + lens).empty());
}

TEST(TomlProblems, AllAreToldInTheOrderOfPlaces) {
    EXPECT_EQ(message_of("colour = 1\n" + lens +
                         "focus = 2\n[scan]\nz_start_um = \"low\"\nz_stop_um = 9\nz_step_um = -1\n"
                         "[[line]]\nwavelength_um = 1\n[[line]]\nwavelength_um = 0\n"),
              "c.toml:1:1: colour = 1: expected a known key (one of line, scan, tube_lens). Remove it.\n"
              "c.toml:5:1: tube_lens.focus = 2: expected a known key (one of focal_length_mm, kind). Remove it.\n"
              "c.toml:7:14: scan.z_start_um = 'low': expected a finite number. Correct scan.z_start_um.\n"
              "c.toml:9:13: scan.z_step_um = -1: expected a finite number > 0. Correct scan.z_step_um.\n"
              "c.toml:13:17: line[1].wavelength_um = 0: expected a finite number in [0.1, 100]. Correct "
              "line[1].wavelength_um.");
}

TEST(TomlProblems, TenAreToldAndTheRestCounted) {
    std::string text = scan + lens;
    for (int i = 0; i < 12; ++i) {
        text += "[[line]]\nwavelength_um = " + std::to_string(-i) + "\n";
    }
    const std::string message = message_of(text);
    EXPECT_EQ(std::ranges::count(message, '\n'), 10);
    EXPECT_THAT(message, AllOf(HasSubstr("line[9].wavelength_um = -9"), Not(HasSubstr("line[10]")),
                               testing::EndsWith("\nand 2 more")));
}

// The list ends soon, however many problems there are.
TEST(TomlProblems, AreBounded) {
    std::string text = scan + lens;
    for (int i = 0; i < 5000; ++i) {
        text += "[[line]]\nunknown = 1\n";
    }
    EXPECT_LE(problems_of(text).size(), 1000u);
}

TEST(TomlProblems, ConsequencesAreNotTold) {
    // A check of two values is left out where one of them could not be read.
    auto problems = problems_of("[scan]\nz_start_um = 5\nz_stop_um = \"high\"\nz_step_um = 1\nbehind = true\n" + lens);
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].key, "scan.z_stop_um");
    // The check itself is the only problem: keys that it left unread are not unknown.
    problems = problems_of("[scan]\nz_start_um = 5\nz_stop_um = 1\nz_step_um = 1\nbehind = true\n" + lens);
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].expected, "a number above z_start_um");
    // A wrong value that decides on all other keys of its table is the only problem.
    problems = problems_of(scan + "[tube_lens]\nkind = \"thick\"\nfocal_length_mm = 200\n");
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].key, "tube_lens.kind");
    // A missing table is one problem, not one for each of its keys.
    problems = problems_of(lens);
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].key, "scan");
}

TEST(TomlProblems, AMissingKeyNamesTheMisspeltOne) {
    EXPECT_EQ(message_of("[scan]\nz_start_um = 0\nz_stop_um = 9\nz_step_nm = 1000\n" + lens),
              "c.toml:4:1: scan.z_step_nm = 1000: expected scan.z_step_um as a finite number > 0. Did you mean "
              "\"z_step_um\"? Rename it, and give its value in um.");
    EXPECT_EQ(
        message_of(scan + "[tubelens]\nkind = \"ideal\"\n"),
        "c.toml:5:2: tubelens = a table {kind = 'ideal'}: expected tube_lens as a table. Did you mean \"tube_lens\"? "
        "Rename it.");
    // Each of two missing keys is matched with its own misspelling; a key that is far from all is reported by itself.
    EXPECT_THAT(message_of("[scan]\nz_strat_um = 0\nz_spot_um = 9\nz_step_um = 1\nfoo = 2\n" + lens),
                AllOf(HasSubstr("2:1: scan.z_strat_um = 0: expected scan.z_start_um"),
                      HasSubstr("3:1: scan.z_spot_um = 9: expected scan.z_stop_um"),
                      HasSubstr("5:1: scan.foo = 2: expected a known key")));
    EXPECT_THAT(
        message_of("[scan]\nz_start_um = 0\nz_stop_um = 9\nfoo = 2\n" + lens),
        AllOf(HasSubstr("1:1: scan.z_step_um: expected a finite number > 0, found nothing. Add z_step_um to [scan]"),
              HasSubstr("4:1: scan.foo = 2: expected a known key")));
}

TEST(TomlProblems, LengthsThatLookLikeNanometresAreTold) {
    EXPECT_THAT(
        message_of(scan + lens + "[[line]]\nwavelength_um = 587.562\n"),
        HasSubstr("9:17: line[0].wavelength_um = 587.562: expected a finite number in [0.1, 100]. 587.562 looks like "
                  "nanometres: write 0.587562."));
    EXPECT_THAT(
        message_of(scan + lens + "[[line]]\nwavelength_um = 0.5\nmore_um = [0.4, 656.3]\n"),
        HasSubstr("line[0].more_um[1] = 656.3: expected a finite number in [0.1, 100]. 656.3 looks like nanometres: "
                  "write 0.6563."));
    EXPECT_THAT(message_of(scan + lens + "[[line]]\nwavelength_um = 1e7\n"), Not(HasSubstr("nanometres")));
    EXPECT_THAT(message_of(scan + lens + "[[line]]\nwavelength_um = 0.01\n"), Not(HasSubstr("nanometres")));
}

TEST(TomlProblems, OverridesThatAreNoneAreToldTogether) {
    try {
        (void)TomlTable::parse("", "c.toml", {{"a b", "1", "--set"}, {"c", "2", "--set"}, {"", "3", "--set"}});
        FAIL() << "accepted";
    } catch (const InputError& error) {
        EXPECT_EQ(error.problems().size(), 2u);
    }
    const auto problems = problems_of(scan + lens + "x = 1\n", {{"scan.z_step_um", "0", "--set"}});
    ASSERT_EQ(problems.size(), 2u);
    EXPECT_EQ(problems[0].key, "tube_lens.x"); // the file's before the command line's
    EXPECT_EQ(problems[1].where.file, "--set");
}

TEST(TomlProblems, ErrorsOfOtherFilesStandBehind) {
    const auto root = TomlTable::parse("lens = \"other.toml\"\nsize = 0\n", "c.toml");
    root.collect_problems();
    root.attempt("lens", [&] {
        throw InputError(std::vector<InputProblem>{{{.file = "other.toml", .line = 3}, "a", "1", "x", ""},
                                                   {{.file = "other.toml", .line = 1}, "b", "1", "x", ""}});
    });
    (void)root.number("size", NumberRange::positive());
    try {
        root.reject_unknown_keys();
        FAIL() << "accepted";
    } catch (const InputError& error) {
        ASSERT_EQ(error.problems().size(), 3u);
        EXPECT_EQ(error.problem().key, "size");
        EXPECT_EQ(error.problems()[1].key, "a"); // in the order of the error, not of its lines
        EXPECT_THAT(error.with_each([](InputProblem& problem) { problem.key = "z"; }).what(),
                    StartsWith("c.toml:2:8: z = 0"));
    }
}

} // namespace
} // namespace vkfv
