// Variants of X3P, SUR, SDF and AL3D that other programs write are read.
#include "surface_files/al3d.hpp"
#include "surface_files/sdf.hpp"
#include "surface_files/sur.hpp"
#include "surface_files/x3p.hpp"

#include "core/messages/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <zip.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace vkfv::surface::variants {
namespace {

using ZipEntries = std::vector<std::pair<std::string, std::string>>;

std::string zipped(const ZipEntries& entries) {
    const auto path =
        std::filesystem::path(testing::TempDir()) / ("vkfv_variants_" + std::to_string(::getpid()) + ".zip");
    int error = 0;
    zip_t* archive = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &error);
    for (const auto& [name, content] : entries)
        zip_file_add(archive, name.c_str(), zip_source_buffer(archive, content.data(), content.size(), 0), 0);
    EXPECT_EQ(zip_close(archive), 0);
    std::ifstream stream(path, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    std::filesystem::remove(path);
    return bytes;
}

// The main.xml of 2 x 2 points whose heights stand in `data`, an element of Record3.
std::string main_xml(const std::string& data, const std::string& rotation = "") {
    return "<p:ISO5436_2 xmlns:p='http://www.opengps.eu/2008/ISO5436_2'><Record1><FeatureType>SUR</FeatureType><Axes>"
           "<CX><AxisType>I</AxisType><Increment>1e-6</Increment></CX>"
           "<CY><AxisType>I</AxisType><Increment>1e-6</Increment></CY>"
           "<CZ><AxisType>A</AxisType><DataType>D</DataType></CZ>" +
           rotation +
           "</Axes></Record1><Record3><MatrixDimension><SizeX>2</SizeX><SizeY>2</SizeY><SizeZ>1</SizeZ>"
           "</MatrixDimension>" +
           data + "</Record3></p:ISO5436_2>";
}

std::string data_list(const std::vector<std::string>& points) {
    std::string text = "<DataList>";
    for (const std::string& point : points)
        text += "<Datum>" + point + "</Datum>\n";
    return text + "</DataList>";
}

const std::string link = "<DataLink><PointDataLink>bindata/data.bin</PointDataLink></DataLink>";

std::string rotation_of(const std::string& first) {
    std::string text = "<Rotation><r11>" + first + "</r11>";
    for (const char* name : {"r12", "r13", "r21", "r22", "r23", "r31", "r32", "r33"})
        text += std::string("<") + name + (name[1] == name[2] ? ">1.0</" : ">0</") + name + ">";
    return text + "</Rotation>";
}

// The heights in um, in the file's order.
std::vector<double> x3p_heights(const ZipEntries& entries) {
    const HeightMap map = parse_x3p(zipped(entries), "a.x3p").map;
    std::vector<double> um;
    for (int row = map.rows() - 1; row >= 0; --row)
        for (int column = 0; column < map.columns(); ++column)
            um.push_back(map.height(column, row) * 1e3);
    return um;
}

template <class Parse>
void expect_told(Parse parse, const std::string& part, const std::string& absent = "\n") {
    try {
        parse();
        ADD_FAILURE() << "accepted: " << part;
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr(part));
        EXPECT_THAT(error.what(), testing::Not(testing::HasSubstr(absent)));
    }
}

std::string doubles(const std::vector<double>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)};
}

TEST(SurfaceVariants, X3pWithDataInline) {
    const auto near = [](double value) { return testing::DoubleNear(value, 1e-9); };
    EXPECT_THAT(x3p_heights({{"main.xml", main_xml(data_list({"1e-6", "", "0;0;-2e-6", ";;NaN"}))}}),
                testing::ElementsAre(near(1), testing::IsNan(), near(-2), testing::IsNan()));
    expect_told([] { x3p_heights({{"main.xml", main_xml(data_list({"1", "2", "3"}))}}); }, "3 points");
    expect_told([] { x3p_heights({{"main.xml", main_xml(data_list({"1", "2", "3", "high"}))}}); }, "high");
    expect_told([] { x3p_heights({{"main.xml", main_xml("")}}); }, "DataList");
}

TEST(SurfaceVariants, X3pOfAFolderAndWithTheIdentity) {
    const std::string points = doubles({1e-6, 2e-6, 3e-6, 4e-6});
    const auto are = testing::ElementsAre(testing::DoubleNear(1, 1e-9), testing::DoubleNear(2, 1e-9),
                                          testing::DoubleNear(3, 1e-9), testing::DoubleNear(4, 1e-9));
    EXPECT_THAT(x3p_heights({{"a/b/main.xml", main_xml(link)}, {"a/b/bindata/data.bin", points}}), are);
    EXPECT_THAT(x3p_heights({{"main.xml", main_xml(link, rotation_of("1"))}, {"bindata/data.bin", points}}), are);
    for (const char* turned : {"-1", "0.5", "", "1e-9"})
        expect_told(
            [&] {
                x3p_heights({{"main.xml", main_xml(link, rotation_of(turned))}, {"bindata/data.bin", points}});
            },
            "otation");
}

// The name of the root element does not matter.
TEST(SurfaceVariants, X3pOfAnyRoot) {
    const std::string xml = main_xml(data_list({"1e-6", "2e-6", "3e-6", "4e-6"}));
    const auto expected = parse_x3p(zipped({{"main.xml", xml}}), "a.x3p").map.height.values;
    for (const char* root : {"ISO5436_2", "ISO5436", "q:ISO5436_2"}) {
        std::string other = xml;
        for (const char* end : {"<", "</"}) {
            const std::string from = std::string(end) + "p:ISO5436_2";
            const auto at = other.find(from);
            ASSERT_NE(at, std::string::npos);
            other.replace(at, from.size(), std::string(end) + root);
        }
        if (root[0] == 'q')
            other.replace(other.find("xmlns:p"), 7, "xmlns:q");
        EXPECT_EQ(parse_x3p(zipped({{"main.xml", other}}), "a.x3p").map.height.values, expected) << root;
    }
    EXPECT_THROW((void)parse_x3p(zipped({{"main.xml", "<ISO5436_2><Record1/></ISO5436_2>"}}), "a.x3p"), InputError);
}

// pyx3p stores a byte for each point, where a bit is meant.
TEST(SurfaceVariants, X3pWhoseValidPointsAreAByteEach) {
    std::string points;
    for (const double metres : {1e-6, 2e-6, 3e-6, 4e-6})
        points.append(reinterpret_cast<const char*>(&metres), sizeof metres);
    const std::string xml = main_xml("<DataLink><PointDataLink>bindata/data.bin</PointDataLink>"
                                     "<ValidPointsLink>bindata/valid.bin</ValidPointsLink></DataLink>");
    const auto read = [&](const std::string& valid) {
        return parse_x3p(zipped({{"main.xml", xml}, {"bindata/data.bin", points}, {"bindata/valid.bin", valid}}),
                         "a.x3p");
    };
    const SurfaceFile bits = read("\x0b"), bytes = read(std::string("\1\1\0\1", 4));
    EXPECT_TRUE(bits.warnings.empty());
    ASSERT_EQ(bytes.warnings.size(), 1u);
    EXPECT_THAT(bytes.warnings[0], testing::HasSubstr("a byte for each point"));
    for (const SurfaceFile& file : {bits, bytes}) {
        // The first line of the file has the highest y.
        EXPECT_DOUBLE_EQ(file.map.height(0, 1), 1e-3);
        EXPECT_DOUBLE_EQ(file.map.height(1, 1), 2e-3);
        EXPECT_TRUE(std::isnan(file.map.height(0, 0)));
        EXPECT_DOUBLE_EQ(file.map.height(1, 0), 4e-3);
    }
    EXPECT_THROW((void)read("\1\1"), InputError);
}

TEST(SurfaceVariants, OtherZipsAreNotCalledX3p) {
    for (const ZipEntries& entries :
         {ZipEntries{{"index.xml", "<xml/>"}, {"LAYER_0.raw", "1"}}, ZipEntries{{"[Content_Types].xml", "<Types/>"}}})
        expect_told([&] { x3p_heights(entries); }, "a ZIP archive of another kind", "n X3P");
    expect_told([] { (void)parse_x3p("PK\x03\x04", "a.xlsx"); }, "a whole ZIP archive", "X3P");
}

// Digits of heights are stored, equal values packed; a reader finds the same in both.
TEST(SurfaceVariants, X3pPacksWhatShrinks) {
    constexpr int side = 200;
    constexpr std::size_t bytes_of_heights = std::size_t{side} * side * sizeof(double);
    HeightMap rough{.height = Grid<double>(side, side), .pitch_x = 1e-3, .pitch_y = 1e-3};
    const HeightMap flat = rough;
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    std::ranges::generate(rough.height.values, [&] { return normal(random); });
    const std::string of_rough = x3p_bytes(rough, {}), of_flat = x3p_bytes(flat, {});
    EXPECT_GT(of_rough.size(), bytes_of_heights);
    EXPECT_LT(of_rough.size(), bytes_of_heights + 4096);
    EXPECT_LT(of_flat.size(), bytes_of_heights / 20);
    EXPECT_EQ(parse_x3p(of_flat, "a.x3p").map.height.values, flat.height.values);
    const auto read = parse_x3p(of_rough, "a.x3p").map.height.values;
    ASSERT_EQ(read.size(), rough.height.values.size());
    for (std::size_t k = 0; k < read.size(); ++k) {
        ASSERT_NEAR(read[k], rough.height.values[k], 1e-12);
    }
}

// pyx3p fails at empty elements.
TEST(SurfaceVariants, WrittenX3pHasNoEmptyElement) {
    HeightMap map{.height = Grid<double>(2, 2), .pitch_x = 1e-3, .pitch_y = 1e-3};
    const std::string bytes = x3p_bytes(map, {});
    EXPECT_EQ(parse_x3p(bytes, "a.x3p").provenance, Provenance{});
    const auto path =
        std::filesystem::path(testing::TempDir()) / ("vkfv_variants_" + std::to_string(::getpid()) + ".x3p");
    std::ofstream(path, std::ios::binary) << bytes;
    zip_t* archive = zip_open(path.c_str(), ZIP_RDONLY, nullptr);
    zip_stat_t stat;
    ASSERT_EQ(zip_stat(archive, "main.xml", 0, &stat), 0);
    std::string xml(stat.size, '\0');
    zip_file_t* entry = zip_fopen(archive, "main.xml", 0);
    EXPECT_EQ(zip_fread(entry, xml.data(), xml.size()), static_cast<zip_int64_t>(xml.size()));
    zip_fclose(entry);
    zip_discard(archive);
    std::filesystem::remove(path);
    EXPECT_THAT(xml, testing::HasSubstr("<Model>unknown</Model>"));
    EXPECT_THAT(xml, testing::Not(testing::HasSubstr("/>")));
}

HeightMap slope(int columns, int rows) {
    HeightMap map{.height = Grid<double>(columns, rows), .pitch_x = 1e-3, .pitch_y = 2e-3};
    for (std::size_t k = 0; k < map.height.values.size(); ++k)
        map.height.values[k] = 0.25 * static_cast<double>(k);
    return map;
}

TEST(SurfaceVariants, SurOfTypeOneWithSeveralRows) {
    std::string bytes = sur_bytes(slope(3, 2), {});
    bytes[18] = 1;
    EXPECT_EQ(parse_sur(bytes, "a.sur").map.height.values, slope(3, 2).height.values);
    std::string profile = sur_bytes(slope(3, 1), {});
    profile[18] = 1;
    expect_told([&] { (void)parse_sur(profile, "a.sur"); }, "a surface");
    // A file without a unit of length is refused for that, not for a missing option.
    bytes[212] = ' ';
    bytes[213] = ' ';
    expect_told([&] { (void)parse_sur(bytes, "a.sur"); }, "unit of length = nothing");
}

// Gwyddion 2.62 shows each inversion so; lists begin at the lowest y.
TEST(SurfaceVariants, SurWithAnInversionAndTheMicroSignOfDos) {
    std::string bytes = sur_bytes(slope(3, 2), {});
    constexpr std::size_t inversion_at = 290, units_at = 180, unit_length = 16;
    const double h = 0.25;
    const std::vector<std::vector<double>> expected = {{0, h, 2 * h, 3 * h, 4 * h, 5 * h},
                                                       {0, -h, -2 * h, -3 * h, -4 * h, -5 * h},
                                                       {-2 * h, -h, 0, -5 * h, -4 * h, -3 * h},
                                                       {-3 * h, -4 * h, -5 * h, 0, -h, -2 * h}};
    for (std::size_t inversion = 0; inversion < expected.size(); ++inversion) {
        bytes[inversion_at] = static_cast<char>(inversion);
        EXPECT_EQ(parse_sur(bytes, "a.sur").map.height.values, expected[inversion]) << inversion;
    }
    bytes[inversion_at] = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
        bytes.replace(units_at + axis * unit_length, 2, "\xE6m");
    EXPECT_NEAR(parse_sur(bytes, "a.sur").map.height(1, 0), 1e-3 * h, 1e-15);
}

template <class Stored>
std::string sdf_of(int type, const std::vector<Stored>& points) {
    std::string bytes = sdf_bytes(slope(3, 2), {}).substr(0, 81);
    bytes[79] = static_cast<char>(type);
    return bytes + std::string(reinterpret_cast<const char*>(points.data()), points.size() * sizeof(Stored));
}

// Stored values of ISO 25178-71, table 2, with the value that means "not measured" where a type has one.
template <class Stored>
void expect_sdf(int type, std::optional<Stored> mark) {
    std::vector<Stored> points = {10, 20, 30, 40, 50, 60};
    if (mark)
        points[5] = *mark;
    const auto map = parse_sdf(sdf_of(type, points), "a.sdf").map;
    EXPECT_NEAR(map.height(0, 1), 10e3, 1e-9) << type; // m
    EXPECT_NEAR(map.height(1, 0), 50e3, 1e-9) << type;
    EXPECT_EQ(std::isnan(map.height(2, 0)), mark.has_value()) << type;
}

TEST(SurfaceVariants, SdfOfEveryType) {
    expect_sdf<std::uint8_t>(0, {});
    expect_sdf<std::uint16_t>(1, 65535);
    expect_sdf<std::uint32_t>(2, 4294967295);
    expect_sdf<float>(3, std::numeric_limits<float>::quiet_NaN());
    expect_sdf<float>(3, std::numeric_limits<float>::lowest());
    expect_sdf<std::int8_t>(4, {});
    expect_sdf<std::int16_t>(5, -32768);
    expect_sdf<std::int32_t>(6, std::numeric_limits<std::int32_t>::min());
    expect_sdf<double>(7, std::numeric_limits<double>::quiet_NaN());
    expect_sdf<double>(7, std::numeric_limits<double>::lowest());
    expect_told([] { (void)parse_sdf(sdf_of<double>(8, std::vector<double>(6)), "a.sdf"); }, "data type = 8");
}

TEST(SurfaceVariants, SdfOfEveryMagic) {
    const auto expected = slope(3, 2).height.values;
    const auto renamed = [](std::string bytes, const std::string& magic) { return bytes.replace(0, 8, magic); };
    for (const char* magic : {"bISO-1.0", "bBCR-1.0"}) {
        const std::string bytes = renamed(sdf_bytes(slope(3, 2), {}), magic);
        ASSERT_TRUE(looks_like_sdf(bytes)) << magic;
        EXPECT_EQ(parse_sdf(bytes, "a.sdf").map.height.values, expected) << magic;
    }
    for (const char* magic : {"aISO-1.0", "aISO-2.0", "aBCR-1.0", "aBCR-0.0", "aNPL-1.0"}) {
        const std::string bytes = renamed(sdf_text(slope(3, 2), {}), magic);
        ASSERT_TRUE(looks_like_sdf(bytes)) << magic;
        EXPECT_EQ(parse_sdf(bytes, "a.sdf").map.height.values, expected) << magic;
    }
    EXPECT_FALSE(looks_like_sdf("aISO-3.0"));
}

// Version 2.0 counts in 32 bits and marks gaps in bytes too. MountainsMap 11 leaves bytes of its memory behind the
// name.
TEST(SurfaceVariants, SdfOfVersionTwo) {
    const auto wide = [](std::string bytes, int type) {
        bytes.replace(0, 18, std::string("bISO-2.0test\0\x07\xff\x01xy", 18));
        bytes[79] = static_cast<char>(type);
        bytes.insert(46, 2, '\0');
        bytes.insert(44, 2, '\0');
        return bytes;
    };
    const auto file = parse_sdf(wide(sdf_bytes(slope(3, 2), {}), 7), "a.sdf");
    EXPECT_EQ(file.map.height.values, slope(3, 2).height.values);
    EXPECT_EQ(file.map.pitch_y, slope(3, 2).pitch_y);
    EXPECT_EQ(file.provenance.manufacturer, "test");
    const auto bytes = parse_sdf(wide(sdf_of<std::int8_t>(4, {1, 2, -128, 4, -127, 6}), 4), "a.sdf").map;
    EXPECT_TRUE(std::isnan(bytes.height(2, 1)));
    EXPECT_NEAR(bytes.height(1, 0), -127e3, 1e-9);
    expect_told([&] { (void)parse_sdf(wide(sdf_bytes(slope(3, 2), {}), 7).substr(0, 84), "a.sdf"); }, "header");
}

std::string al3d_of(int rows, const std::string& more_tag, std::size_t row_bytes) {
    const auto tag = [](std::string key, std::string value) {
        key.resize(20, '\0');
        value.resize(30, '\0');
        return key + value + "\r\n";
    };
    std::string bytes("AliconaImaging\0\r\n", 17);
    bytes += tag("Version", "1") + tag("TagCount", "6") + tag("Rows", std::to_string(rows)) + tag("Cols", "3") +
             tag("PixelSizeXMeter", "1e-06") + tag("PixelSizeYMeter", "2e-06") + tag("DepthImageOffset", "440");
    bytes += more_tag.empty() ? tag("Comment", "") : tag(more_tag, std::to_string(440 + row_bytes * 3));
    bytes.resize(440, '\0');
    for (int row = 0; row < rows; ++row) {
        std::string line(row_bytes, '\0');
        for (int column = 0; column < 3; ++column) {
            const float metres = 1e-3f * static_cast<float>(3 * (rows - 1 - row) + column);
            std::memcpy(line.data() + 4 * column, &metres, sizeof metres);
        }
        bytes += line;
    }
    return bytes;
}

TEST(SurfaceVariants, Al3dWithAndWithoutPadding) {
    for (const std::size_t row_bytes : {std::size_t{12}, std::size_t{16}})
        for (const char* texture : {"", "TextureImageOffset"}) {
            std::string bytes = al3d_of(3, texture, row_bytes);
            if (*texture)
                bytes += std::string(100, 'x');
            const HeightMap map = parse_al3d(bytes, "a.al3d").map;
            for (int k = 0; k < 9; ++k)
                EXPECT_NEAR(map.height.values[static_cast<std::size_t>(k)], k, 1e-6) << row_bytes << texture << k;
        }
}

} // namespace
} // namespace vkfv::surface::variants
