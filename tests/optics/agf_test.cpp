#include "optics/media/agf.hpp"

#include "core/messages/error.hpp"
#include "optics/media/glass_catalog.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

namespace vkfv::optics {
namespace {

using ::testing::HasSubstr;

// Two glasses of our own: n = 1.5 + 0.01 / x, and n^2 = 4 at 2 um (1 + 3 * 4 / (4 - 0)).
const std::string catalogue = "Text of no keyword, as some vendors' files begin\r\n"
                              "CC a catalogue for tests\r\n"
                              "! a remark\r\n"
                              "NM ONE 5 0 1.517020 60.00 0 1\r\n"
                              "GC\tany text at all\r\n"
                              "ED 7.1 8.3 2.51 -0.0009 0\r\n"
                              "CD 1.5 1.0E-002 0 0.0E+000 0\r\n"
                              "TD 0 0 0 0 0 0 20\r\n"
                              "OD -1 -1 -1 -1 -1 -1\r\n"
                              "LD 4.0E-001 +7.0E-001\r\n"
                              "IT 4.0E-001 9.9E-001 2.5E+001\r\n"
                              "\r\n"
                              "NM TWO 2 -\r\n"
                              "MD 1 2\r\n"
                              "LD 0.4 2.5\r\n"
                              "CD 3\r\n"
                              "BD 0";

std::string utf16(const std::string& text, bool big_endian) {
    std::string bytes = big_endian ? "\xfe\xff" : "\xff\xfe";
    for (const char character : text) {
        bytes += big_endian ? std::string{'\0', character} : std::string{character, '\0'};
    }
    return bytes;
}

void expect_catalogue(const AgfGlasses& glasses) {
    const auto& media = glasses.media;
    ASSERT_EQ(media.size(), 2u);
    EXPECT_EQ(media[0].name, "ONE");
    EXPECT_EQ(media[0].source, "x.agf");
    EXPECT_DOUBLE_EQ(media[0].index(0.5), 1.52);
    EXPECT_THROW(media[0].index(0.71), InputError);
    EXPECT_EQ(media[1].name, "TWO");
    EXPECT_DOUBLE_EQ(media[1].index(2.0), 2.0);
}

TEST(Agf, ReadsNameFormulaCoefficientsAndRange) {
    expect_catalogue(parse_agf(catalogue, "folder/x.agf"));
}

TEST(Agf, ReadsEveryEncodingAndLineEnd) {
    std::string unix_lines;
    for (const char character : catalogue) {
        if (character != '\r') {
            unix_lines += character;
        }
    }
    expect_catalogue(parse_agf(unix_lines, "x.agf"));
    expect_catalogue(parse_agf("\xef\xbb\xbf" + catalogue, "x.agf"));
    expect_catalogue(parse_agf(utf16(catalogue, false), "x.agf"));
    expect_catalogue(parse_agf(utf16(catalogue, true), "x.agf"));
    // A letter of a name is the same in Latin-1, UTF-8 and UTF-16.
    const std::string rest = " 5\nCD 1.5\nLD 1 2\n";
    const std::string expected = "\xc3\xa9";
    EXPECT_EQ(parse_agf("NM \xe9" + rest, "x").media[0].name, expected);
    EXPECT_EQ(parse_agf("NM " + expected + rest, "x").media[0].name, expected);
    const auto wide = utf16("NM ", false) + std::string("\xe9\0", 2) + utf16(rest, false).substr(2);
    EXPECT_EQ(parse_agf(wide, "x").media[0].name, expected);
    // A code point beyond 16 bits is read, and half of one is not.
    const std::string pair = std::string("\x3c\xd8", 2) + "\x0d\xdf"; // U+1F30D
    EXPECT_EQ(parse_agf(utf16("NM ", false) + pair + utf16(rest, false).substr(2), "x").media[0].name,
              "\xf0\x9f\x8c\x8d");
    EXPECT_EQ(parse_agf(utf16("NM ", false) + pair.substr(0, 2) + utf16(rest, false).substr(2), "x").media[0].name,
              "?");
}

TEST(Agf, TakesAllThirteenFormulas) {
    for (int number = 1; number <= 13; ++number) {
        const auto media = parse_agf("NM G " + std::to_string(number) + "\nCD 1.25 0.5\nLD 1 2\n", "x.agf").media;
        const auto& glass = std::get<GlassFormula>(media.at(0).dispersion);
        EXPECT_EQ(static_cast<int>(glass.formula), number);
        ASSERT_EQ(glass.coefficients.size(), coefficient_count(glass.formula));
        EXPECT_EQ(glass.coefficients[0], 1.25);
        EXPECT_EQ(glass.coefficients[1], 0.5);
        EXPECT_EQ(glass.coefficients.back(), 0);
    }
}

TEST(Agf, LinesOfNumbersContinueTheOneBefore) {
    const std::string whole = "NM G 13 1 1.5 70 0 0 1\nCD 2.25 0.001 -2E-4 9E-3 7E-5 4E-6 -1E-7 0 0 0\n"
                              "TD 1 2 3 4 5 6 7\nLD 0.4 2.1\nIT 0.4 0.9 10\nNM H 5\nCD 1.5\nLD 0.4 0.7\n";
    const std::string wrapped = "NM G 13 1 1.5\n70 0 0 1\nCD 2.25 0.001 -2E-4 9E-3 \r\n7E-5 4E-6 -1E-7 0\n"
                                "! a remark between\n+0 0\nTD 1 2 3\n4 5 6 7\nLD 0.4\n 2.1\nIT 0.4\n.9 10\n"
                                "NM H 5\nCD 1.5\nLD 0.4 0.7\n";
    const auto expected = parse_agf(whole, "x.agf").media;
    const auto media = parse_agf(wrapped, "x.agf").media;
    ASSERT_EQ(media.size(), 2u);
    EXPECT_EQ(media[0].dispersion, expected[0].dispersion);
    EXPECT_EQ(media[1].dispersion, expected[1].dispersion);
    const auto& coefficients = std::get<GlassFormula>(media[0].dispersion).coefficients;
    EXPECT_EQ(coefficients.at(4), 7E-5); // the first of the second line
    // The wrong twin: without the continued lines the index is another.
    const auto cut = parse_agf("NM G 13\nCD 2.25 0.001 -2E-4 9E-3\nLD 0.4 2.1\n", "x.agf").media;
    EXPECT_NE(cut[0].index(0.5), media[0].index(0.5));
}

TEST(Agf, TheFirstGlassOfANameIsTakenAndTheLogTellsOfOthers) {
    std::ostringstream log;
    const auto before = spdlog::default_logger();
    spdlog::set_default_logger(
        std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_st>(log)));
    const std::string first = "NM G 5\nCD 1.5\nLD 1 2\n";
    const auto same = parse_agf(first + first, "x.agf").media;
    const std::string without_twins = log.str();
    const auto media = parse_agf(first + "NM F 5\nCD 1.7\nLD 1 2\nNM G 5\nCD 1.6\nLD 1 2\n", "x.agf").media;
    spdlog::set_default_logger(before);
    EXPECT_EQ(same.size(), 1u);
    EXPECT_EQ(without_twins, ""); // the same glass twice
    ASSERT_EQ(media.size(), 2u);
    EXPECT_DOUBLE_EQ(media[0].index(1.5), 1.5);
    EXPECT_THAT(log.str(), HasSubstr("x.agf"));
    EXPECT_THAT(log.str(), HasSubstr("G (lines 1 and 7)"));
    // A catalogue does not tell these two names apart, and keeps the first glass.
    GlassCatalog glasses;
    glasses.add(parse_agf("NM A-B 5\nCD 1.5\nLD 1 2\nNM a_b 5\nCD 1.6\nLD 1 2\n", "x.agf"), "x.agf");
    EXPECT_DOUBLE_EQ(glasses.get("A-B").index(1.5), 1.5);
}

TEST(Agf, FaultsNameFileLineAndKeyword) {
    const std::string good = "NM G 5\nCD 1.5\nLD 1 2\n";
    const struct {
        std::string text;
        int line;
        std::string key;
        std::string found;
    } rows[] = {
        {"", 0, "NM", "no glass"},
        {"CC only\n", 0, "NM", "no glass"},
        {std::string(1000, '\0'), 0, "NM", "no glass"},
        {"NM\n", 1, "NM", "NM"},
        {"NM G\n", 1, "NM", "G"},
        {"NM G x\n", 1, "NM", "x"},
        {"NM G 0\n", 1, "NM", "0"},
        {"NM G 14\n", 1, "NM", "14"},
        {"NM G 2.5\n", 1, "NM", "2.5"},
        {"NM G nan\n", 1, "NM", "nan"},
        {"CD 1.5\n", 1, "CD", "CD"},
        {"\nLD 1 2\n", 2, "LD", "LD"},
        {"NM G 5\nCD\nLD 1 2\n", 2, "CD of \"G\"", "CD"},
        {"NM G 5\nCD 1.5 1,2\nLD 1 2\n", 2, "CD of \"G\"", "1,2"},
        {"NM G 5\nCD 1.5 inf\nLD 1 2\n", 2, "CD of \"G\"", "inf"},
        {"NM G 5\nCD 1.5 1e999\nLD 1 2\n", 2, "CD of \"G\"", "1e999"},
        {"NM G 5\nCD 1.5x\nLD 1 2\n", 2, "CD of \"G\"", "1.5x"},
        {"NM G 5\nCD 1.5 0 0 0.1\nLD 1 2\n", 2, "CD of \"G\"", "0.1"}, // Conrady's has three
        {"NM G 5\nCD 1.5\nCD 1.5\nLD 1 2\n", 3, "CD of \"G\"", "CD 1.5"},
        {"NM G 5\nCD 1.5\nLD 1\n", 3, "LD of \"G\"", "1"},
        {"NM G 5\nCD 1.5\nLD 2 1\n", 3, "LD of \"G\"", "2 1"},
        {"NM G 5\nCD 1.5\nLD 0 1\n", 3, "LD of \"G\"", "0 1"},
        {"NM G 5\nCD 1.5\nLD a b\n", 3, "LD of \"G\"", "a"},
        {good + "LD 1 2\n", 4, "LD of \"G\"", "LD 1 2"},
        {good + "XY 1\n", 4, "XY of \"G\"", "XY"},
        {good + "\xff\xfe\x01\n", 4, "of \"G\"", "\xc3\xbf"},
        {"NM G 5\nCD 1.5\n0 0\n0.1\nLD 1 2\n", 4, "CD of \"G\"", "0.1"}, // wrapped
        {"NM G 5\nCD 1.5\n0 1,2\nLD 1 2\n", 3, "CD of \"G\"", "1,2"},
        {"NM G 5\nCD 1.5\n0,1 2\nLD 1 2\n", 3, "0,1 of \"G\"", "0,1"},
        {"NM G 5\nLD 1 2\n", 1, "CD of \"G\"", "nothing"},
        {"NM F 5\nCD 1.5\nNM G 5\nCD 1.5\n", 1, "LD of \"F\"", "nothing"},
    };
    for (const auto& row : rows) {
        SCOPED_TRACE(row.text);
        try {
            parse_agf(row.text, "x.agf");
            ADD_FAILURE() << "accepted";
        } catch (const InputError& error) {
            const auto& problem = error.problem();
            EXPECT_EQ(problem.where.file, "x.agf");
            EXPECT_EQ(problem.where.line, row.line);
            EXPECT_THAT(problem.key, HasSubstr(row.key));
            EXPECT_THAT(problem.found, HasSubstr(row.found));
            EXPECT_FALSE(problem.expected.empty() || problem.remedy.empty());
        }
    }
}

// A record that is wrong costs its own glass alone, wherever in the file it stands.
TEST(Agf, OtherGlassesAreReadBesideAWrongRecord) {
    const std::string good = "NM G 5\nCD 1.5\nLD 1 2\n";
    for (const std::string wrong : {"NM F 5\nCD 1.5\nLD 0 0\n", "NM F 5\nCD 1,5\nLD 1 2\n", "NM F 99\nCD 1.5\nLD 1 2\n",
                                    "NM F 5\nLD 1 2\n", "NM F 5\nCD 1.5\nXY 1\nLD 1 2\n"}) {
        for (const std::string& text : {wrong + good, good + wrong, wrong + good + "NM H 5\nCD 1.6\nLD 1 2\n"}) {
            SCOPED_TRACE(text);
            const AgfGlasses read = parse_agf(text, "x.agf");
            EXPECT_EQ(std::ranges::count(read.media, "G", &Medium::name), 1);
            EXPECT_EQ(std::ranges::count(read.media, "F", &Medium::name), 0);
            ASSERT_EQ(read.unusable.count("F"), 1u);
            GlassCatalog glasses;
            glasses.add(read, "x.agf");
            EXPECT_DOUBLE_EQ(glasses.get("G").index(1.5), 1.5);
            try {
                glasses.get("F");
                ADD_FAILURE() << "accepted";
            } catch (const InputError& error) {
                EXPECT_THAT(error.what(), HasSubstr("x.agf:"));
            }
        }
    }
}

TEST(Agf, ReadsFiles) {
    const auto folder = std::filesystem::path(VKFV_BINARY_DIR) / "agf";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "x.agf", std::ios::binary) << catalogue;
    expect_catalogue(read_agf(folder / "x.agf"));
    EXPECT_THROW(read_agf(folder / "absent.agf"), InputError);
    EXPECT_THROW(read_agf(folder), InputError);
}

} // namespace
} // namespace vkfv::optics
