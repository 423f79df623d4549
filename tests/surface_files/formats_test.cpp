// GSF, GWY, NPY, tables of heights, and the formats of instruments that are read alone are read from files as other
// programs write them, byte by byte, and hostile ones are refused.
#include "support/instrument_files.hpp"
#include "surface_files/gsf.hpp"
#include "surface_files/gwy.hpp"
#include "surface_files/height_table.hpp"
#include "surface_files/instruments.hpp"
#include "surface_files/npy.hpp"
#include "surface_files/sur.hpp"

#include "core/messages/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vkfv::surface::formats {
namespace {

constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

HeightMap wave(int columns = 37, int rows = 23) {
    HeightMap map{.height = Grid<double>(columns, rows),
                  .x0 = -1.0 / 3,
                  .y0 = 1e-5 / 3,
                  .pitch_x = 1.0 / 3000,
                  .pitch_y = 0.1 / 7};
    for (std::size_t k = 0; k < map.height.values.size(); ++k)
        map.height.values[k] = k % 11 == 3 ? not_measured : 1e-3 * std::sin(0.37 * static_cast<double>(k));
    return map;
}

const Provenance provenance = {.creator = "vkfv",
                               .manufacturer = "none",
                               .model = "10x \"tube\"",
                               .serial = "7",
                               .version = "1",
                               .date = "2026-01-31T12:34:56Z",
                               .comment = "two\nlines"};

void expect_same_map(const HeightMap& found, const HeightMap& expected, double tolerance) {
    ASSERT_EQ(found.columns(), expected.columns());
    ASSERT_EQ(found.rows(), expected.rows());
    EXPECT_DOUBLE_EQ(found.pitch_x, expected.pitch_x);
    EXPECT_DOUBLE_EQ(found.pitch_y, expected.pitch_y);
    for (std::size_t k = 0; k < expected.height.values.size(); ++k) {
        const double z = expected.height.values[k];
        if (std::isnan(z))
            EXPECT_TRUE(std::isnan(found.height.values[k])) << k;
        else
            EXPECT_NEAR(found.height.values[k], z, tolerance * std::abs(z)) << k;
    }
}

template <class Parse>
void expect_refusal(Parse parse, const std::string& part) {
    try {
        parse();
        ADD_FAILURE() << "accepted: " << part;
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr(part));
        EXPECT_FALSE(error.problem().remedy.empty());
    }
}

TEST(SurfaceFormats, GsfGwyAndTableReadBackAndAreWrittenTheSame) {
    for (const Provenance& known : {Provenance{}, provenance}) {
        const std::string gsf = gsf_bytes(wave(), known), gwy = gwy_bytes(wave(), known),
                          table = height_table(wave(), known);
        const auto read_gsf = parse_gsf(gsf, "a.gsf"), read_gwy = parse_gwy(gwy, "a.gwy"),
                   read_table = parse_height_table(table, "a.csv", {});
        expect_same_map(read_gsf.map, wave(), std::ldexp(1, -23));
        expect_same_map(read_gwy.map, wave(), std::ldexp(1, -51));
        expect_same_map(read_table.map, wave(), 0);
        for (const auto* file : {&read_gsf, &read_gwy, &read_table}) {
            EXPECT_NEAR(file->map.x0, wave().x0, 1e-16);
            EXPECT_NEAR(file->map.y0, wave().y0, 1e-20);
            EXPECT_TRUE(file->provenance == known);
        }
        EXPECT_TRUE(gsf_bytes(read_gsf.map, read_gsf.provenance) == gsf);
        EXPECT_TRUE(gwy_bytes(read_gwy.map, read_gwy.provenance) == gwy);
        EXPECT_TRUE(height_table(read_table.map, read_table.provenance) == table);
    }
}

TEST(SurfaceFormats, TextOfATableThatLooksLikeItsScaleStaysText) {
    Provenance named = provenance;
    named.comment = "two lines\npitch_x_mm=1.5\nx0_mm=-7\nValue units: m";
    const std::string table = height_table(wave(), named);
    const auto read = parse_height_table(table, "a.csv", {});
    expect_same_map(read.map, wave(), 0);
    EXPECT_EQ(read.provenance.comment, named.comment);
    EXPECT_EQ(height_table(read.map, read.provenance), table);
    // A line of the heading that is no comment is not part of it.
    const auto at = table.find("# manufacturer");
    const auto other = parse_height_table(table.substr(0, at) + "re#v sion=2\n" + table.substr(at), "a.csv", {});
    EXPECT_TRUE(other.provenance == named);
}

TEST(SurfaceFormats, HostileGsfIsRefused) {
    const std::string good = gsf_bytes(wave(), {});
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string bytes = good;
        return bytes.replace(bytes.find(from), from.size(), to);
    };
    const auto refused = [](const std::string& bytes, const std::string& part) {
        expect_refusal([&] { (void)parse_gsf(bytes, "a.gsf"); }, part);
    };
    refused(good.substr(0, good.size() - 1), "points");
    refused(good.substr(0, 30), "header");
    refused(with("XRes = 37", "XRes = 4294967296"), "points");
    refused(with("XRes = 37", "XRes = -3"), "XRes = -3");
    refused(with("ZUnits = m", "ZUnits = V"), "unit of length");
    refused(with("XReal = ", "XReal = -"), "positive spacing");
}

// A second channel is left alone; a channel of other values is passed over.
TEST(SurfaceFormats, GwyOfSeveralChannels) {
    const std::string bytes =
        gwy_bytes({{"Contrast", "", wave()}, {"Height", "m", wave(5, 4)}, {"More", "m", wave()}}, provenance);
    const auto file = parse_gwy(bytes, "a.gwy");
    expect_same_map(file.map, wave(5, 4), 1e-15);
    EXPECT_EQ(file.provenance, provenance);
    expect_refusal([] { (void)parse_gwy(gwy_bytes({{"Contrast", "", wave()}}, {}), "a.gwy"); }, "a channel whose");
    for (const std::size_t length : {std::size_t{5}, std::size_t{30}, bytes.size() / 2, bytes.size() - 1})
        expect_refusal([&] { (void)parse_gwy(bytes.substr(0, length), "a.gwy"); }, "");
}

std::string npy_of(const std::string& type, const std::string& order, const std::string& shape,
                   const std::string& points, char version = 1) {
    const std::string header = "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }\n";
    std::string bytes = "\x93NUMPY" + std::string{version, '\0'};
    bytes += static_cast<char>(header.size());
    bytes += std::string(version == 1 ? 1 : 3, '\0');
    return bytes + header + points;
}

TEST(SurfaceFormats, NpyOfEveryTypeAndOrder) {
    using test::raw_points;
    const ImageScale scale{.pitch = 2e-3, .unit = 0.5};
    // The array has 2 lines of 3; by columns these heights lie in another order.
    const std::vector<double> by_rows = {1, 2, 3, 4, 5, 6}, by_columns = {1, 4, 2, 5, 3, 6};
    const auto expect = [&](const std::string& bytes) {
        const HeightMap map = parse_npy(bytes, "a.npy", scale).map;
        EXPECT_THAT(map.height.values, testing::ElementsAre(2, 2.5, 3, 0.5, 1, 1.5));
        EXPECT_EQ(map.columns(), 3);
        EXPECT_EQ(map.pitch_y, 2e-3);
    };
    expect(npy_of("<f8", "False", "(2, 3)", raw_points<double>(by_rows)));
    expect(npy_of("<f4", "False", "(2, 3,)", raw_points<float>(by_rows), 2));
    expect(npy_of("|u1", "True", "(2,3)", raw_points<std::uint8_t>(by_columns)));
    expect(npy_of("<i2", "True", "(2, 3)", raw_points<std::int16_t>(by_columns)));
    expect(npy_of(">i2", "False", "(2, 3)", std::string("\0\1\0\2\0\3\0\4\0\5\0\6", 12)));
    expect(npy_of("<u4", "False", "(2, 3)", raw_points<std::uint32_t>(by_rows)));
    expect(npy_of("<i8", "False", "(2, 3)", raw_points<std::int64_t>(by_rows), 3));
    const HeightMap read = parse_npy(npy_bytes(wave()), "a.npy", {.pitch = 1, .unit = 1e-3}).map;
    EXPECT_TRUE(npy_bytes(read) == npy_bytes(wave()));

    const auto refused = [&](const std::string& bytes, const std::string& part) {
        expect_refusal([&] { (void)parse_npy(bytes, "a.npy", scale); }, part);
    };
    refused(npy_of("<f8", "False", "(6,)", raw_points<double>(by_rows)), "two dimensions");
    refused(npy_of("<f8", "False", "(2, 3, 2)", raw_points<double>(by_rows)), "two dimensions");
    refused(npy_of("<c8", "False", "(2, 3)", raw_points<double>(by_rows)), "descr");
    refused(npy_of("<f8", "Maybe", "(2, 3)", raw_points<double>(by_rows)), "True or False");
    refused(npy_of("<f8", "False", "(20000, 10000)", "1"), "bytes from here on");
    refused(npy_of("<f8", "False", "(4294967296, 4294967296)", "1"), "points");
    expect_refusal([&] { (void)parse_npy(npy_bytes(wave()), "a.npy", {}); }, "unit");
}

// The heights of the lines of a table, first line first.
std::vector<double> table_values(const std::string& text, const char* name = "a.csv") {
    const HeightMap map = parse_height_table(text, name, {.pitch = 1, .unit = 1}).map;
    std::vector<double> values;
    for (int row = map.rows() - 1; row >= 0; --row)
        for (int column = 0; column < map.columns(); ++column)
            values.push_back(map.height(column, row));
    return values;
}

TEST(SurfaceFormats, TablesOfEverySeparator) {
    using testing::ElementsAre;
    for (const char* text :
         {"1.5,2,-3\n4,5,6e0\n", "1.5;2;-3\r\n4;5;6\r\n", "1,5;2,0;-3,0\n4;5;6", "1.5\t2\t-3\n4\t5\t6\n",
          "  1.5   2 -3\n  4 5\t6 \n", "1,5 2,0 -3,0\n4,0 5,0 6,0\n", "1.5, 2, -3\n4, 5, 6\n",
          "\xEF\xBB\xBF"
          "1.5,2,-3,\n4,5,6,\n",
          "Height map\nof 2 lines\n\n1.5,2,-3\n4,5,6\n# the end\n"})
        EXPECT_THAT(table_values(text), ElementsAre(1.5, 2, -3, 4, 5, 6)) << text;
    EXPECT_THAT(table_values("1,NaN,3\n,5,***\n"),
                ElementsAre(1, testing::IsNan(), 3, testing::IsNan(), 5, testing::IsNan()));
    for (const auto& [text, part] :
         {std::pair{"1,2\n3\n", "columns = 1"}, {"1,2\n3,4x\n", "4x"}, {"words\n", "no line"}, {"1\n2 3\n", "columns"}})
        expect_refusal([text = text] { (void)table_values(text); }, part);
    expect_refusal([] { (void)parse_height_table(std::string("1\0002", 3), "a.csv", {}); }, "NUL");
    expect_refusal([] { (void)parse_height_table("1 2\n3 4\n", "a.csv", {}); }, "unit = not given");
    expect_refusal([] { (void)parse_height_table("1 2\n3 4\n", "a.csv", {.pitch = {}, .unit = 1}); }, "pitch");
}

TEST(SurfaceFormats, TableOfGwyddionStatesItsScale) {
    const std::string text =
        "# Channel: Topo\n# Width: 10 \xC2\xB5m\n# Height: 4.0 nm\n# Value units: m\n1e-6 2e-6\n3e-6 4e-6\n";
    const HeightMap map = parse_height_table(text, "a.txt", {}).map;
    EXPECT_DOUBLE_EQ(map.pitch_x, 5e-3);
    EXPECT_DOUBLE_EQ(map.pitch_y, 2e-6);
    EXPECT_DOUBLE_EQ(map.height(0, 1), 1e-3);
    const SurfaceFile contradicted = parse_height_table(text, "a.txt", {.pitch = 1, .unit = {}});
    EXPECT_EQ(contradicted.map.pitch_x, map.pitch_x);
    EXPECT_EQ(contradicted.warnings.size(), 1u);
}

// SPIP's headers have the unit of an extent in a line of its own, NanoFocus' have factors, Gwyddion's may be German.
TEST(SurfaceFormats, TablesOfOtherProgramsStateTheirScale) {
    const char* rows = "1 2\n3 4\n";
    for (const char* header : {"# x-pixels = 2\n# y-pixels = 2\n# x-length = 4\n# y-length = 8\n# x-unit = um\n# "
                               "y-unit = um\n# z-unit = nm\n",
                               "# x-length = 4000\n# y-length = 8000\n# z-unit = nm\n",
                               "# x-length = 4 um\n# y-length = 8 um\n# z-unit = nm\n",
                               "# Kanal: Topo\n# Breite: 4 \xC2\xB5m\n# H\xC3\xB6he: 8 \xC2\xB5m\n# Einheit: nm\n"}) {
        const HeightMap map = parse_height_table(std::string(header) + rows, "a.asc", {}).map;
        EXPECT_DOUBLE_EQ(map.pitch_x, 2e-3) << header;
        EXPECT_DOUBLE_EQ(map.pitch_y, 4e-3) << header;
        EXPECT_NEAR(map.height(1, 0), 4e-6, 1e-18) << header;
    }
    const std::string focus = "w = 2\nh = 2\npixel size = 2e-06 m\nheight conversion factor (-> m) = 1e-9\n";
    const HeightMap map = parse_height_table(focus + rows, "a.txt", {}).map;
    EXPECT_DOUBLE_EQ(map.pitch_x, 2e-3);
    EXPECT_NEAR(map.height(1, 0), 4e-6, 1e-18);
    // An extent without any unit is no extent.
    expect_refusal(
        [&] {
            (void)parse_height_table(std::string("# x-length = 4\n# y-length = 8\n") + rows, "a.txt",
                                     {.pitch = {}, .unit = 1});
        },
        "pitch");
}

TEST(SurfaceFormats, PointsOnAGrid) {
    // Points may be in any order; one is left out.
    const HeightMap map = parse_height_table("x y z\n1.0 5 1\n1.5 5 2\n2.0 5 3\n1.0 5.25 4\n2.0 5.25 6\n", "a.xyz",
                                             {.pitch = {}, .unit = 1e-3})
                              .map;
    ASSERT_EQ(map.columns(), 3);
    ASSERT_EQ(map.rows(), 2);
    EXPECT_DOUBLE_EQ(map.pitch_x, 0.5e-3);
    EXPECT_DOUBLE_EQ(map.pitch_y, 0.25e-3);
    EXPECT_DOUBLE_EQ(map.x0, 1e-3);
    EXPECT_DOUBLE_EQ(map.height(0, 0), 1e-3);
    EXPECT_TRUE(std::isnan(map.height(1, 1)));
    EXPECT_DOUBLE_EQ(map.height(2, 1), 6e-3);
    // Three columns of heights are a matrix.
    EXPECT_EQ(table_values("1.01 2.3 3\n1.2 7.7 2\n3.4 5.1 1\n9.12 1.4 3\n").size(), 12u);
    expect_refusal([] { (void)table_values("1.01 2.3 3\n1.2 7.7 2\n3.4 5.1 1\n9.12 1.4 3\n", "a.xyz"); }, "grid");
    expect_refusal([] { (void)table_values("0 0 3\n1e9 0 2\n1 1e9 1\n2 2 3\n", "a.xyz"); }, "grid");
}

using test::instrument_file;

struct InstrumentFormat {
    const char* name;
    SurfaceFile (*parse)(std::string_view, const std::filesystem::path&);
    bool (*looks_like)(std::string_view);
};
constexpr InstrumentFormat instrument_formats[] = {{"plu", parse_plu, looks_like_plu},
                                                   {"opd", parse_opd, looks_like_opd},
                                                   {"dat", parse_metropro, looks_like_metropro},
                                                   {"nms", parse_nms, looks_like_nms}};

TEST(SurfaceFormats, FilesOfInstruments) {
    for (const auto& [name, parse, looks_like] : instrument_formats) {
        const std::string bytes = instrument_file(name);
        ASSERT_TRUE(looks_like(bytes)) << name;
        const HeightMap map = parse(bytes, name).map;
        ASSERT_EQ(map.columns(), 3) << name;
        ASSERT_EQ(map.rows(), 2) << name;
        EXPECT_NEAR(map.pitch_x, 1e-3, 1e-9) << name;
        const bool gap = std::string(name) != "nms";
        // The first line of the file's picture is 1 2 3 um, the second 4 (a gap) 6.
        const std::vector<double> um = {4, gap ? not_measured : 5, 6, 1, 2, 3};
        for (std::size_t k = 0; k < um.size(); ++k)
            if (std::isnan(um[k]))
                EXPECT_TRUE(std::isnan(map.height.values[k])) << name << k;
            else
                EXPECT_NEAR(map.height.values[k], um[k] * 1e-3, 2e-7) << name << k;
        for (std::size_t length = 0; length < bytes.size(); length += 17)
            if (looks_like(bytes.substr(0, length))) {
                EXPECT_THROW((void)parse(bytes.substr(0, length), name), InputError) << name << length;
            }
        for (const InstrumentFormat& other : instrument_formats)
            if (other.parse != parse) {
                EXPECT_THROW((void)other.parse(bytes, name), InputError) << name;
            }
    }
}

// The first bytes tell the format, 1 to 3, of MetroPro's header, whose length differs.
TEST(SurfaceFormats, MetroproOfEveryFormat) {
    const std::string first = instrument_file("dat");
    const auto expected = parse_metropro(first, "a.dat").map.height.values;
    for (const int format : {2, 3}) {
        std::string bytes = first;
        bytes[3] = static_cast<char>(0x6e + format);
        bytes[5] = static_cast<char>(format);
        if (format == 3) {
            bytes.insert(834, 4096 - 834, '\0');
            bytes[8] = '\x10', bytes[9] = '\0';
        }
        ASSERT_TRUE(looks_like_metropro(bytes)) << format;
        EXPECT_THAT(parse_metropro(bytes, "a.dat").map.height.values,
                    testing::Pointwise(testing::NanSensitiveDoubleEq(), expected))
            << format;
    }
}

// A file of several surfaces says which one is read.
TEST(SurfaceFormats, TheFirstOfSeveralIsNamed) {
    std::string plu = instrument_file("plu"), sur = sur_bytes(wave(), {});
    EXPECT_TRUE(parse_plu(plu, "a.plu").warnings.empty());
    EXPECT_TRUE(parse_sur(sur, "a.sur").warnings.empty());
    plu[489] = '\2';
    sur[14] = '\3';
    const std::vector<GwyChannel> two = {{"Contrast", "", wave()}, {"Height", "m", wave()}, {"More", "m", wave()}};
    EXPECT_TRUE(parse_gwy(gwy_bytes({two[0], two[1]}, {}), "a.gwy").warnings.empty());
    EXPECT_THAT(parse_plu(plu, "a.plu").warnings, testing::ElementsAre(testing::HasSubstr("first of its 2 layers")));
    EXPECT_THAT(parse_sur(sur, "a.sur").warnings, testing::ElementsAre(testing::HasSubstr("first of its 3 surfaces")));
    EXPECT_THAT(parse_gwy(gwy_bytes(two, {}), "a.gwy").warnings,
                testing::ElementsAre(testing::HasSubstr("first of its 2 channels of heights is read, \"Height\"")));
}

TEST(SurfaceFormats, TextOfZygo) {
    for (const std::string& text : {test::zygo_phases(), test::zygo_points()}) {
        ASSERT_TRUE(looks_like_zygo_text(text));
        const SurfaceFile file = parse_zygo_text(text, "a.xyz", {});
        const HeightMap& map = file.map;
        ASSERT_EQ(map.columns(), 3);
        ASSERT_EQ(map.rows(), 2);
        EXPECT_NEAR(map.pitch_x, 1e-3, 1e-12);
        const std::vector<double> um = {4, not_measured, 6, 1, 2, 3};
        for (std::size_t k = 0; k < um.size(); ++k)
            if (std::isnan(um[k]))
                EXPECT_TRUE(std::isnan(map.height.values[k])) << k;
            else
                EXPECT_NEAR(map.height.values[k], um[k] * 1e-3, 1e-12) << k;
        EXPECT_EQ(file.provenance.serial, "17");
        EXPECT_EQ(file.provenance.date, "2011-07-23T16:49:36Z");
    }
    for (std::size_t length = 20; length + 10 < test::zygo_phases().size(); length += 5) {
        EXPECT_THROW((void)parse_zygo_text(test::zygo_phases().substr(0, length), "a.asc", {}), InputError) << length;
    }
    // XYZ files do not state the unit, which Mx lets its user choose, and sometimes not the pitch.
    EXPECT_EQ(parse_zygo_text(test::zygo_points(), "a.xyz", {}).warnings.size(), 1U);
    const SurfaceFile waves = parse_zygo_text(test::zygo_points(), "a.xyz", {.pitch = {}, .unit = 0.6328e-3});
    EXPECT_TRUE(waves.warnings.empty());
    EXPECT_NEAR(waves.map.height(2, 1), 3 * 0.6328e-3, 1e-12);
    std::string text = test::zygo_points();
    text.replace(text.find("1e-06"), 5, "0");
    EXPECT_THROW((void)parse_zygo_text(text, "a.xyz", {}), InputError);
    EXPECT_EQ(parse_zygo_text(text, "a.xyz", {.pitch = 0.002, .unit = {}}).map.pitch_y, 0.002);
    EXPECT_EQ(parse_zygo_text(test::zygo_points(), "a.xyz", {.pitch = 0.002, .unit = 1e-3}).warnings.size(), 1U);
    EXPECT_THROW((void)parse_zygo_text(test::zygo_phases(), "a.asc", {.pitch = {}, .unit = 1e-3}), InputError);
    // Heights may fall where phases would rise; points that the header does not name are refused.
    text = test::zygo_phases();
    text.replace(text.find("20 2 0 0 0 0 0"), 14, "20 2 0 0 0 1 0");
    EXPECT_NEAR(parse_zygo_text(text, "a.asc", {}).map.height(0, 1), -1e-3, 1e-12);
    for (const auto& [from, to] : {std::pair<std::string, std::string>{"10 20 3 2", "10 20 99999999 2"},
                                   {"12\t20\t3.0", "13 20 3.0"},
                                   {"10 21 4.0", "10 21 4.0.0"},
                                   {"10 21 4.0", "10 21"}}) {
        text = test::zygo_points();
        text.replace(text.find(from), from.size(), to);
        EXPECT_THROW((void)parse_zygo_text(text, "a.xyz", {}), InputError) << to;
    }
}

// Vision64 gives its block another name.
TEST(SurfaceFormats, OpdOfEveryNameOfItsBlock) {
    const std::string bytes = instrument_file("opd");
    const auto expected = parse_opd(bytes, "a.opd").map.height.values;
    const auto at = bytes.find("RAW_DATA");
    ASSERT_NE(at, std::string::npos);
    const auto named = [&](std::string name) {
        name.resize(8, '\0');
        return std::string(bytes).replace(at, 8, name);
    };
    for (const char* name : {"Raw", "RAW DATA", "OPD"}) {
        const auto found = parse_opd(named(name), "a.opd").map.height.values;
        ASSERT_EQ(found.size(), expected.size()) << name;
        for (std::size_t k = 0; k < found.size(); ++k)
            EXPECT_TRUE(found[k] == expected[k] || (std::isnan(found[k]) && std::isnan(expected[k]))) << name << k;
    }
    EXPECT_THROW((void)parse_opd(named("Other"), "a.opd"), InputError);
    // Vision also writes dates without zeros at their beginning.
    std::string dated = named("OPD");
    const auto replace = [&dated](const std::string& from, std::string to) {
        to.resize(from.size(), '\0');
        dated.replace(dated.find(from), from.size(), to);
    };
    EXPECT_EQ(parse_opd(dated, "a.opd").provenance.date, "2009-10-26T11:16:55Z");
    replace("10/26/2009", "1/2/2003");
    replace("11:16:55", "4:05:6");
    EXPECT_EQ(parse_opd(dated, "a.opd").provenance.date, "2003-01-02T04:05:06Z");
    // Heights may have a byte each, in steps of 5 nm.
    std::string of_bytes = bytes;
    const auto size = of_bytes.find(std::string("\3\0\2\0\2\0", 6));
    ASSERT_NE(size, std::string::npos);
    of_bytes.replace(size + 4, 8, "\1\0\x20\x03\xC8\x07\xFF\x7F", 8);
    const auto map = parse_opd(of_bytes, "a.opd").map;
    EXPECT_NEAR(map.height(0, 0), 0x20 * 5e-6, 1e-12);
    EXPECT_NEAR(map.height(0, 1), 0x03 * 5e-6, 1e-12);
    EXPECT_NEAR(map.height(2, 0), 0xFF * 5e-6, 1e-12);
}

} // namespace
} // namespace vkfv::surface::formats
