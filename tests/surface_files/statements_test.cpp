// Files state units, pitches and the marks of points that were not measured beside the heights; the readers believe
// them.
#include "core/messages/error.hpp"
#include "surface_files/height_image.hpp"
#include "surface_files/height_table.hpp"
#include "surface_files/image_scale.hpp"
#include "surface_files/npy.hpp"
#include "surface_files/surface_file.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

namespace vkfv::surface::statements {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsNan;

constexpr double um = 1e-3; // mm

SurfaceFile table(const std::string& text, const ImageScale& scale = {}) {
    return parse_height_table(text, "a.csv", scale);
}

// The heights in um, first line first.
std::vector<double> heights_of(const SurfaceFile& file) {
    std::vector<double> values;
    for (int row = file.map.rows() - 1; row >= 0; --row)
        for (int column = 0; column < file.map.columns(); ++column)
            values.push_back(file.map.height(column, row) / um);
    return values;
}

auto near(double value) {
    return testing::DoubleNear(value, 1e-9 * std::abs(value) + 1e-12);
}

constexpr ImageScale given = {.pitch = 2 * um, .unit = um};

template <class Parse>
void expect_refusal(Parse parse, const std::string& part) {
    try {
        parse();
        ADD_FAILURE() << "accepted: " << part;
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr(part));
    }
}

TEST(TableStatements, MarksOfPointsThatWereNotMeasured) {
    for (const char* mark : {"1.70141e38", "1.701410009187827989e+38", "-1.70141E+38", "3.4028235e38", "1e38", "NaN"})
        EXPECT_THAT(heights_of(table(std::string("1,2\n") + mark + ",4\n", given)),
                    ElementsAre(near(1), near(2), IsNan(), near(4)))
            << mark;
    EXPECT_THAT(heights_of(table("1,2\n1e30,4\n", given))[2], near(1e30)); // warned of, not taken for a mark
    // A value that is a mark in micrometres is one in metres too: a map is written in another unit and read again.
    EXPECT_THAT(heights_of(table("# Value units: m\n1,2\n1e34,4\n", {.pitch = 2 * um, .unit = {}}))[2], IsNan());
    for (const char* header :
         {"NODATA_value -9999", "# nodata: -9999", "no data value = -9999.0", "Missing value\t-9999",
          "\"Bad data\",\"-9999\"", "# Fill value; -9.999e3", "nodata -9999"})
        EXPECT_THAT(heights_of(table(std::string(header) + "\n1,2\n-9999,-9998\n", given)),
                    ElementsAre(near(1), near(2), IsNan(), near(-9998)))
            << header;
    EXPECT_THAT(heights_of(table("1,2\n-9999,4\n", given))[2], near(-9999)); // nobody said it
}

TEST(TableStatements, GapsHaveManyWordsAndStandAnywhere) {
    for (const char* gap :
         {"inf",    "-inf",    "Infinity", "-nan",    "NaN", "NA",  "N/A", "#N/A", "#DIV/0!", "NULL",
          "masked", "Invalid", "1.#QNAN",  "-1.#IND", "BAD", "***", "---", "\"\"", "",        "nan(ind)"})
        for (const char separator : {',', ';', '\t'}) {
            const auto line = [&](const std::string& first, const std::string& second, const std::string& third) {
                return first + separator + second + separator + third + "\n";
            };
            const std::string cell = gap;
            if (cell.empty() && separator == '\t')
                continue; // a tab at the beginning of a line may as well indent it
            // At the beginning of the first line it is no heading's word, and at the end of a line no closing
            // separator.
            EXPECT_THAT(heights_of(table(line(cell, "2", "3") + line("4", cell, "6") + line("7", "8", cell), given)),
                        ElementsAre(IsNan(), near(2), near(3), near(4), IsNan(), near(6), near(7), near(8), IsNan()))
                << gap << separator;
            EXPECT_THAT(heights_of(table(line("1", "2", cell) + line("4", "5", cell) + line("7", "8", "9"), given)),
                        ElementsAre(near(1), near(2), IsNan(), near(4), near(5), IsNan(), near(7), near(8), near(9)))
                << gap << separator;
        }
    // Separators that close every line are no column.
    EXPECT_EQ(table("1,2,\n3,4,\n", given).map.columns(), 2);
    EXPECT_EQ(table(";;;\nz;;;\n1;2;\n3;4;\n", given).map.columns(), 2);
    for (const char* header : {"_FillValue: 1e20", "Undefined = 1e20", "# NaN value = 1e20", "\"Invalid\",\"1e20\"",
                               "NODATA_value 1,0e20", "NODATA 1e20", "Invalid;1e20", "void 1e20"})
        EXPECT_THAT(heights_of(table(std::string(header) + "\n1,2\n1e20,4\n", given))[2], IsNan()) << header;
}

TEST(TableStatements, AGridOfEsriCountsInOneUnit) {
    const std::string header = "ncols 2\nnrows 2\nxllcorner 10\nyllcorner 20\ncellsize 2.0\nNODATA_value -9999\n";
    const SurfaceFile file = table(header + "1 2\n-9999 4\n", {.pitch = {}, .unit = um});
    EXPECT_THAT(heights_of(file), ElementsAre(near(1), near(2), IsNan(), near(4)));
    EXPECT_THAT(file.map.pitch_x, near(2 * um));
    EXPECT_THAT(file.map.pitch_y, near(2 * um));
    EXPECT_THAT(file.map.x0, near(11 * um)); // of the point in the cell's middle
    EXPECT_THAT(file.map.y0, near(21 * um));
    EXPECT_TRUE(file.warnings.empty());
    EXPECT_TRUE(table(header + "1 2\n3 4\n", given).warnings.empty()); // the same pitch twice
    const SurfaceFile other = table(header + "1 2\n3 4\n", {.pitch = 3 * um, .unit = um});
    ASSERT_EQ(other.warnings.size(), 1u);
    EXPECT_THAT(other.warnings[0], testing::AllOf(HasSubstr("2 um"), HasSubstr("3 um"), HasSubstr("a.csv")));
    // Cells that are no squares, and decimal commas.
    const SurfaceFile oblong = table("ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ndx 2,5\ndy 3,0\n1,5 2,0\n3,0 4,5\n",
                                     {.pitch = {}, .unit = um});
    EXPECT_THAT(heights_of(oblong), ElementsAre(near(1.5), near(2), near(3), near(4.5)));
    EXPECT_THAT(oblong.map.pitch_x, near(2.5 * um));
    EXPECT_THAT(oblong.map.pitch_y, near(3 * um));
}

TEST(TableStatements, UnitsInTheNamesOfColumnsAreUsed) {
    const std::string points = "0,0,5\n0.002,0,6\n0,0.002,7\n0.002,0.002,8\n";
    for (const char* names :
         {"x [mm],y [mm],z [um]", "X (mm);Y (mm);Z (\xC2\xB5m)", "x/mm,y/mm,z/\xCE\xBCm",
          "# x [mm], y [mm], z [\xC2\xB5m]", "x,y,z\nmm,mm,um", "x\ty\tz\n[mm]\t[mm]\t[um]", "X<mm>,Y<mm>,Z<um>",
          "\"x [mm]\",\"y [mm]\",\"height [micron]\"", "# x (mm) y (mm) z (um)", "x_mm,y_mm,z_um", "X mm,Y mm,Z um",
          "x in mm,y in mm,height in micrometers", "X [MM],Y [MM],Z [UM]", "x {mm},y {mm},z {micrometre}",
          "x, mm;y, mm;z, um"}) {
        const SurfaceFile file = table(std::string(names) + "\n" + points);
        EXPECT_THAT(heights_of(file), ElementsAre(near(7), near(8), near(5), near(6))) << names;
        EXPECT_THAT(file.map.pitch_x, near(0.002)) << names;
        EXPECT_THAT(file.map.pitch_y, near(0.002)) << names;
        EXPECT_TRUE(file.warnings.empty()) << names;
        // An option of the same unit says nothing new; another unit is told of, and not used.
        EXPECT_TRUE(table(std::string(names) + "\n" + points, {.pitch = {}, .unit = um}).warnings.empty()) << names;
        const SurfaceFile contradicted = table(std::string(names) + "\n" + points, {.pitch = {}, .unit = 1.0});
        ASSERT_EQ(contradicted.warnings.size(), 1u) << names;
        EXPECT_THAT(contradicted.warnings[0], testing::AllOf(HasSubstr("1 um"), HasSubstr("1000 um"))) << names;
        EXPECT_EQ(contradicted.map.height.values, file.map.height.values) << names;
    }
    // A matrix has one unit.
    EXPECT_THAT(heights_of(table("Height [nm]\n1000,2000\n3000,4000\n", {.pitch = um, .unit = {}})),
                ElementsAre(near(1), near(2), near(3), near(4)));
    EXPECT_THAT(heights_of(table("Height\nnm\n1000,2000\n3000,4000\n", {.pitch = um, .unit = {}})),
                ElementsAre(near(1), near(2), near(3), near(4)));
    // Brackets without a unit of length say nothing, nor does a line of which one word alone is a unit.
    EXPECT_THROW((void)table("x,y,z\npx,px,um\n" + points), InputError);
    EXPECT_THROW((void)table("x [px],y [px],z [V]\n" + points), InputError);
    // Positions in a unit that is no length need the pitch.
    EXPECT_THROW((void)table("x [px],y [px],z [um]\n" + points), InputError);
    EXPECT_THAT(table("x [px],y [px],z [um]\n" + points, {.pitch = 3 * um, .unit = {}}).map.pitch_x, near(3 * um));
    for (const auto& [unit, mm] :
         {std::pair("in", 25.4), std::pair("inches", 25.4), std::pair("mil", 0.0254), std::pair("\xC3\x85", 1e-7),
          std::pair("angstroms", 1e-7), std::pair("nanometers", 1e-6), std::pair("Metre", 1e3),
          std::pair("centimetres", 10.0)})
        EXPECT_THAT(table(fmt::format("x [{0}],y [{0}],z [{0}]\n", unit) + points).map.pitch_x, near(0.002 * mm))
            << unit;
}

TEST(TableStatements, TablesOfInstrumentsAndSpreadsheetsHaveQuotes) {
    const std::string header = "\"Date\",\"2023/05/03\"\n\"XY Calibration\",\"2000\",\"nm\"\n\"Unit\",\"\xC2\xB5m\"\n"
                               "\"Horizontal\",\"2\"\n\n\"Height\"\n";
    const SurfaceFile file = table(header + "\"-0.160\",\"0.033\"\n\"0.292\",\"\"\n");
    EXPECT_THAT(heights_of(file), ElementsAre(near(-0.160), near(0.033), near(0.292), IsNan()));
    EXPECT_THAT(file.map.pitch_x, near(2 * um));
    // Numbers may have decimal commas between quotes.
    EXPECT_THAT(heights_of(table("\"1,5\",\"2,25\"\n\"3\",\"4,0\"\n", given)),
                ElementsAre(near(1.5), near(2.25), near(3), near(4)));
    EXPECT_THAT(heights_of(table("\"1,5\";\"2,25\"\n\"3,5\";\"4,0\"\n", given)),
                ElementsAre(near(1.5), near(2.25), near(3.5), near(4)));
    EXPECT_THAT(heights_of(table("\"1.5\" \"2.25\"\n\"3\" \"4\"\n", given)),
                ElementsAre(near(1.5), near(2.25), near(3), near(4)));
}

TEST(TableStatements, TextOfAnyEncoding) {
    const std::string text = "z [\xC2\xB5m]\n1,2\n3,4\n", latin1 = "z [\xB5m]\n1,2\n3,4\n";
    std::string utf16 = "\xff\xfe", unmarked;
    for (const char character : latin1) {
        utf16 += {character, '\0'};
        unmarked += {character, '\0'};
    }
    std::string old_macintosh = text;
    std::ranges::replace(old_macintosh, '\n', '\r');
    for (const std::string& bytes : {text, latin1, utf16, unmarked, "\xEF\xBB\xBF" + text, old_macintosh})
        EXPECT_THAT(heights_of(table(bytes, {.pitch = um, .unit = {}})),
                    ElementsAre(near(1), near(2), near(3), near(4)));
}

TEST(TableStatements, AProfileIsNoMap) {
    std::string two = "Position,Height\n", three = "mm,um,um\n", one = "Height\n", positions, heights;
    for (int k = 0; k < 50; ++k) {
        positions += (k > 0 ? "," : "") + std::to_string(0.5 * k);
        heights += (k > 0 ? "," : "") + std::to_string(std::sin(0.3 * k));
        two += std::to_string(0.5 * k) + "," + std::to_string(std::sin(0.3 * k)) + "\n";
        three += std::to_string(0.5 * k) + "," + std::to_string(std::sin(0.3 * k)) + ",0.5\n";
        one += std::to_string(std::sin(0.3 * k)) + "\n";
    }
    for (const std::string& text : {two, three, one, heights + "\n", positions + "\n" + heights + "\n"}) {
        try {
            (void)table(text, given);
            ADD_FAILURE() << "accepted: " << text.substr(0, 20);
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(), testing::AllOf(HasSubstr("a profile"), HasSubstr("a map of heights")));
        }
    }
    // Profilometers close their lines by empty cells, write the scan's parameters above, or several heights a line.
    std::string closed = "Scan Parameters\nLength,1500.0 um\n\nScan Data\nLateral um,Raw Micrometer,\n";
    std::string several = "X_(microns),y1,y2,y3,y4\n", counted = "\xC2\xB5m \xC2\xB5m\n50\n";
    for (int k = 0; k < 50; ++k) {
        const std::string x = fmt::format("{:.1f}", 0.156 * k), z = std::to_string(std::sin(0.3 * k));
        closed += x + "," + z + ",,\n";
        several += fmt::format("{},{},{},{},{}\n", 0.0386 * (k + 1), z, z, z, z);
        counted += fmt::format("   {:.7e},   {}\n", 1.3 * k, z);
    }
    for (const std::string& text : {closed, several, counted})
        expect_refusal([&] { (void)table(text, given); }, "a profile");
    // Without names only a warning is due, and none for a map whose columns all ascend.
    const std::string unnamed = several.substr(several.find('\n') + 1);
    EXPECT_THAT(table(unnamed, given).warnings, testing::ElementsAre(HasSubstr("first column ascends evenly")));
    std::string axes = "0,0,1,2,3,4,5,6,7,8,9\n";
    for (int k = 0; k < 9; ++k)
        axes += fmt::format("{},1,3,2,3,1,4,2,3,1,2\n", 0.5 * k);
    EXPECT_THAT(table(axes, given).warnings,
                testing::ElementsAre(HasSubstr("column ascends"), HasSubstr("line ascends")));
    std::string ramp;
    for (int k = 0; k < 20; ++k)
        ramp += fmt::format("{},{},{},{}\n", k, k + 1, k + 2, k + 3);
    EXPECT_TRUE(table(ramp, given).warnings.empty());
    // A header that states the size of a map tells that it is one, however its numbers ascend.
    const std::string rows = "1 2 3 4\n5 6 7 8\n9 10 11 13\n";
    for (const char* size : {"# Width: 10 \xC2\xB5m\n# Height: 9 \xC2\xB5m\n", "# x-pixels = 4\n# y-pixels = 3\n",
                             "X Size\t4\nY Size\t3\n", "ncols 4\nnrows 3\ncellsize 2\n",
                             "# x-length = 2000\n# y-length = 1500\n# x-unit = nm\n# y-unit = nm\n"})
        EXPECT_EQ(table(size + rows, given).map.columns(), 4) << size;
    // An extent is not the unit of heights.
    expect_refusal([&] { (void)table("# Width: 10 mm\n# Height: 9 mm\n" + rows + rows); }, "unit_um");
    EXPECT_EQ(table("# Width: 10 mm\n# Height: 9 mm\n" + rows + rows, {.pitch = {}, .unit = um}).map.height(0, 0),
              9 * um);
    // The count of points above their list is no point.
    EXPECT_EQ(table("4\n0 0 1\n1 0 2\n0 1 3\n1 1 4\n", given).map.rows(), 2);
    expect_refusal([] { (void)table("5\n0 0 1\n1 0 2\n0 1 3\n1 1 4\n", given); }, "columns");
    // A map of few columns is a map, not a list of points.
    EXPECT_EQ(table("3,1\n1,2\n2,2\n5,4\n", given).map.columns(), 2);
    EXPECT_EQ(table("1,2,3\n4,5,6\n", given).map.columns(), 3);
    EXPECT_EQ(table(heights + "\n" + heights + "\n", given).map.rows(), 2);
}

// --- Arrays

std::string npy_of(const std::string& type, const std::string& shape, const std::string& points) {
    std::string header = "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }\n";
    return std::string("\x93NUMPY\x01\0", 8) + static_cast<char>(header.size()) + '\0' + header + points;
}

TEST(ArrayStatements, HalfFloats) {
    // The values are 1, -2, the largest (65504), the smallest normal (2^-14), the smallest of all (2^-24), and
    // infinity.
    const std::vector<std::uint16_t> halves = {0x3c00, 0xc000, 0x7bff, 0x0400, 0x0001, 0x7c00};
    std::string little, big;
    for (const std::uint16_t half : halves) {
        little += {static_cast<char>(half & 0xff), static_cast<char>(half >> 8)};
        big += {static_cast<char>(half >> 8), static_cast<char>(half & 0xff)};
    }
    for (const auto& [type, points] : {std::pair{"<f2", little}, {">f2", big}})
        EXPECT_THAT(
            heights_of(parse_npy(npy_of(type, "(2, 3)", points), "a.npy", given)),
            ElementsAre(near(1), near(-2), near(65504), near(std::ldexp(1, -14)), near(std::ldexp(1, -24)), IsNan()));
}

TEST(ArrayStatements, LengthsOfOneHaveNoMeaning) {
    std::string points;
    for (const float value : {1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f})
        points.append(reinterpret_cast<const char*>(&value), sizeof value);
    for (const char* shape : {"(2, 3)", "(1, 2, 3)", "(2, 3, 1)", "(1, 2, 3, 1)", "(2, 1, 3)"})
        EXPECT_THAT(heights_of(parse_npy(npy_of("<f4", shape, points), "a.npy", given)),
                    ElementsAre(near(1), near(2), near(3), near(4), near(5), near(6)))
            << shape;
    EXPECT_EQ(parse_npy(npy_of("<f4", "(1, 6)", points), "a.npy", given).map.columns(), 6);
    for (const char* shape : {"(6,)", "(1, 6, x)", "(3, 2, 2)", "()"})
        EXPECT_THROW((void)parse_npy(npy_of("<f4", shape, points + points), "a.npy", given), InputError) << shape;
}

// --- Images

struct Tag {
    std::uint16_t number, type;
    std::uint32_t count;
    std::string value; // as it stands in the file
};

template <class Value>
std::string stored(std::initializer_list<Value> values) {
    std::string bytes;
    for (const Value value : values)
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    return bytes;
}

// A little-endian file of 2 x 2 floats 1 2 / 3 4, but for the first one; tags are in the order of their numbers.
std::string tiff_of(float first, const std::vector<Tag>& more) {
    constexpr std::uint16_t is_short = 3, is_long = 4;
    constexpr std::uint32_t values_at = 8, directory_at = 24;
    std::vector<Tag> tags = {
        {256, is_short, 1, stored<std::uint16_t>({2})},  {257, is_short, 1, stored<std::uint16_t>({2})},
        {258, is_short, 1, stored<std::uint16_t>({32})}, {259, is_short, 1, stored<std::uint16_t>({1})},
        {262, is_short, 1, stored<std::uint16_t>({1})},  {273, is_long, 1, stored<std::uint32_t>({values_at})},
        {277, is_short, 1, stored<std::uint16_t>({1})},  {278, is_short, 1, stored<std::uint16_t>({2})},
        {279, is_long, 1, stored<std::uint32_t>({16})},  {339, is_short, 1, stored<std::uint16_t>({3})}};
    tags.insert(tags.end(), more.begin(), more.end());
    std::ranges::stable_sort(tags, {}, &Tag::number);
    std::string bytes =
        std::string("II*\0", 4) + stored<std::uint32_t>({directory_at}) + stored({first, 2.0f, 3.0f, 4.0f});
    bytes += stored<std::uint16_t>({static_cast<std::uint16_t>(tags.size())});
    std::size_t outside_at = directory_at + 2 + 12 * tags.size() + 4;
    std::string outside;
    for (Tag& tag : tags) {
        bytes += stored<std::uint16_t>({tag.number, tag.type}) + stored<std::uint32_t>({tag.count});
        if (tag.value.size() <= 4) {
            tag.value.resize(4);
            bytes += tag.value;
        } else {
            bytes += stored<std::uint32_t>({static_cast<std::uint32_t>(outside_at + outside.size())});
            outside += tag.value;
        }
    }
    return bytes + std::string(4, '\0') + outside;
}

Tag text_tag(std::uint16_t number, const std::string& text) {
    return {number, 2, static_cast<std::uint32_t>(text.size() + 1), text + '\0'};
}

Tag resolution(std::uint16_t number, std::uint32_t pixels, std::uint32_t units) {
    return {number, 5, 1, stored<std::uint32_t>({pixels, units})};
}

TEST(ImageStatements, GdalNamesTheValueOfPointsThatWereNotMeasured) {
    constexpr std::uint16_t gdal_nodata = 42113;
    const auto heights = [&](const std::vector<Tag>& more) {
        return heights_of(parse_height_image(tiff_of(-32768, more), "a.tif", given));
    };
    EXPECT_THAT(heights({text_tag(gdal_nodata, "-32768")}), ElementsAre(IsNan(), near(2), near(3), near(4)));
    EXPECT_THAT(heights({text_tag(gdal_nodata, "-32768 ")}), ElementsAre(IsNan(), near(2), near(3), near(4)));
    EXPECT_THAT(heights({text_tag(gdal_nodata, "-9999")})[0], near(-32768));
    EXPECT_THAT(heights({})[0], near(-32768));
    EXPECT_TRUE(std::isnan(heights_of(parse_height_image(tiff_of(1.70141e38f, {}), "a.tif", given))[0]));
}

TEST(ImageStatements, ImagejStatesUnitAndPitch) {
    const auto with = [](const std::string& description) {
        return tiff_of(1, {text_tag(270, description), resolution(282, 4, 1), resolution(283, 2, 1)});
    };
    const SurfaceFile file = parse_height_image(with("ImageJ=1.53t\nunit=um\nmin=1.0\nmax=4.0\n"), "a.tif", {});
    EXPECT_THAT(heights_of(file), ElementsAre(near(1), near(2), near(3), near(4)));
    EXPECT_THAT(file.map.pitch_x, near(0.25 * um));
    EXPECT_THAT(file.map.pitch_y, near(0.5 * um));
    EXPECT_TRUE(file.warnings.empty());
    const SurfaceFile calibrated =
        parse_height_image(with("ImageJ=1.53t\nunit=micron\ncf=0\nc0=1.0\nc1=2.0\nvunit=nm\n"), "a.tif", {});
    EXPECT_THAT(heights_of(calibrated), ElementsAre(near(3e-3), near(5e-3), near(7e-3), near(9e-3)));
    EXPECT_THAT(calibrated.map.pitch_x, near(0.25 * um));
    // Options go first, and a contradiction is told of.
    EXPECT_TRUE(
        parse_height_image(with("ImageJ=1.53t\nunit=um\n"), "a.tif", {.pitch = {}, .unit = um}).warnings.empty());
    const SurfaceFile other = parse_height_image(with("ImageJ=1.53t\nunit=um\n"), "a.tif", {.pitch = um, .unit = 1.0});
    EXPECT_EQ(other.warnings.size(), 2u);
    EXPECT_THAT(other.map.pitch_x, near(um));
    // A unit of pixels is no length, and neither is no unit at all.
    EXPECT_THROW((void)parse_height_image(with("ImageJ=1.53t\nunit=pixel\n"), "a.tif", {}), InputError);
    EXPECT_THROW((void)parse_height_image(with("ImageJ=1.53t\nunit=um\ncf=1\n"), "a.tif", {}), InputError);
    EXPECT_THROW((void)parse_height_image(with("Height\nunit=um\n"), "a.tif", {}), InputError);
}

// --- Heights that no surface has

TEST(ImplausibleHeights, AreWarnedOf) {
    const auto folder = std::filesystem::path(testing::TempDir()) / ("vkfv_implausible_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    const auto warnings = [&](const std::string& odd) {
        std::string text;
        for (int row = 0; row < 10; ++row)
            for (int column = 0; column < 10; ++column)
                text += (row == 3 && column == 4 ? odd : std::to_string(std::sin(row + 2.0 * column))) +
                        (column < 9 ? "," : "\n");
        std::ofstream(folder / "a.csv") << text;
        return read_surface(folder / "a.csv", given).warnings;
    };
    EXPECT_TRUE(warnings("0.5").empty());
    EXPECT_TRUE(warnings("10000").empty()); // the middle spans 1.8 um or so
    for (const char* odd : {"-99999", "1e30", "-1e36"}) {
        const auto found = warnings(odd);
        ASSERT_EQ(found.size(), 1u) << odd;
        EXPECT_THAT(found[0], testing::AllOf(HasSubstr("1 heights"), HasSubstr("a.csv")));
    }
    // A plane with a single height may be as high as a metre before the reader warns.
    std::ofstream(folder / "a.csv") << "0,0,0,0\n0,0,0,0\n0,0,1e5,0\n0,0,0,0\n";
    EXPECT_TRUE(read_surface(folder / "a.csv", given).warnings.empty());
    std::ofstream(folder / "a.csv") << "0,0,0,0\n0,0,0,0\n0,0,1.1e6,0\n0,0,0,0\n";
    EXPECT_EQ(read_surface(folder / "a.csv", given).warnings.size(), 1u);
    std::filesystem::remove_all(folder);
}

} // namespace
} // namespace vkfv::surface::statements
