// Surface files that are written read back and are written the same again, their bytes are what the formats say,
// foreign files of every variant are read, and hostile ones are refused before they cost anything.
#include "support/surface_files.hpp"
#include "surface_files/surface_file.hpp"

#include "core/messages/error.hpp"
#include "images/image_file.hpp"
#include "surface_files/sdf.hpp"
#include "surface_files/sur.hpp"
#include "surface_files/x3p.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openssl/evp.h>
#include <pugixml.hpp>
#include <zip.h>
#include <zlib.h>

#include <pthread.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <random>

namespace vkfv::surface {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

class SurfaceFiles : public testing::Test {
  protected:
    SurfaceFiles()
        : folder_(std::filesystem::path(testing::TempDir()) /
                  ("vkfv_surface_file_" + std::to_string(::getpid()) + "_" +
                   testing::UnitTest::GetInstance()->current_test_info()->name())) {
        std::filesystem::create_directories(folder_);
    }
    ~SurfaceFiles() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path write(const std::string& name, const std::string& bytes) const {
        std::ofstream(folder_ / name, std::ios::binary) << bytes;
        return folder_ / name;
    }
    std::filesystem::path folder_;
};

std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

template <class Value>
Value at(const std::string& bytes, std::size_t offset) {
    Value value;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

template <class Value>
std::string raw(const Value& value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
}

// The letter F as seen from +z, first line at the highest y; the gap is "?".
const std::vector<std::string> letter = {"######", "#.....", "####..", "#...?.", "#.....", "#....."};
constexpr double ink = 5e-3, paper = -1.25e-3;

HeightMap letter_map() {
    HeightMap map;
    map.height = Grid<double>(6, 6);
    map.pitch_x = 0.00228;
    map.pitch_y = 0.0031;
    map.x0 = -0.125;
    map.y0 = 0.7;
    for (int row = 0; row < 6; ++row)
        for (int column = 0; column < 6; ++column) {
            const char c = letter[static_cast<std::size_t>(5 - row)][static_cast<std::size_t>(column)];
            map.height(column, row) = c == '#' ? ink : c == '?' ? nan : paper;
        }
    return map;
}

std::string seen(const HeightMap& map, double tolerance = 1e-9) {
    std::string text;
    for (int row = map.rows() - 1; row >= 0; --row)
        for (int column = 0; column < map.columns(); ++column) {
            const double z = map.height(column, row);
            text += std::isnan(z)                     ? '?'
                    : std::abs(z - ink) < tolerance   ? '#'
                    : std::abs(z - paper) < tolerance ? '.'
                                                      : '!';
        }
    return text;
}

std::string letter_text() {
    std::string text;
    for (const std::string& line : letter)
        text += line;
    return text;
}

// A map of heights of every size, of either sign, with gaps.
HeightMap wild_map(std::uint32_t seed, double largest) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> exponent(-30, 0), sign(-1, 1);
    HeightMap map;
    map.height = Grid<double>(37, 23);
    map.pitch_x = 1.0 / 3000;
    map.pitch_y = 0.1 / 7;
    map.x0 = -1.0 / 3;
    map.y0 = 1e-5 / 3;
    for (double& height : map.height.values) {
        const double s = sign(random);
        height = std::abs(s) < 0.1 ? nan : std::copysign(largest * std::exp(exponent(random)), s);
    }
    return map;
}

const Provenance full_provenance = {.creator = "vkfv 0.1.0",
                                    .manufacturer = "vkfv project",
                                    .model = "10x/0.28 & \"tube\" <200>",
                                    .serial = "7",
                                    .version = "0.1.0",
                                    .date = "2026-01-31T12:34:56Z",
                                    .comment = "configuration digest 0123\ncreator=of the comment's second line"};

const std::vector<std::string> read_back = {"a.x3p", "a.sur", "a.sdf", "a.asc.sdf", "a.tif"};

TEST_F(SurfaceFiles, WriteReadWriteGivesTheSameBytes) {
    for (const std::string& name : read_back)
        for (const Provenance& provenance :
             {Provenance{}, full_provenance, Provenance{.date = "yesterday", .comment = "*"}})
            for (const double largest : {0.0, 1e-9, 0.00390625, 0.1, 3.7}) {
                const auto first = folder_ / name, second = folder_ / ("b" + name.substr(1));
                write_surface(first, wild_map(3, largest), provenance);
                const SurfaceFile file = read_surface(first);
                write_surface(second, file.map, file.provenance);
                EXPECT_TRUE(bytes_of(first) == bytes_of(second)) << name << " " << largest;
            }
    for (const char* name : {"a.ply", "b.ply"})
        write_surface(folder_ / name, wild_map(3, 0.1), full_provenance);
    EXPECT_TRUE(bytes_of(folder_ / "a.ply") == bytes_of(folder_ / "b.ply"));
}

TEST_F(SurfaceFiles, HeightsGapsGridAndProvenanceComeBack) {
    const HeightMap map = wild_map(5, 0.1);
    for (const std::string& name : read_back) {
        write_surface(folder_ / name, map, full_provenance);
        const SurfaceFile file = read_surface(folder_ / name);
        ASSERT_EQ(file.map.columns(), map.columns()) << name;
        ASSERT_EQ(file.map.rows(), map.rows()) << name;
        // SUR has float32 lengths and steps of 2^-33 mm below 0.125 mm; TIFF float32 heights.
        const bool sur = name == "a.sur", tiff = name == "a.tif";
        // Metres have fewer values than mm in some places: a step of float64 may get lost, once.
        const double step = std::ldexp(1, -52), pitch = sur ? std::ldexp(1, -24) : step;
        EXPECT_NEAR(file.map.pitch_x, map.pitch_x, pitch * map.pitch_x) << name;
        EXPECT_NEAR(file.map.pitch_y, map.pitch_y, pitch * map.pitch_y) << name;
        if (name != "a.sdf") {
            EXPECT_NEAR(file.map.x0, map.x0, pitch) << name;
            EXPECT_NEAR(file.map.y0, map.y0, pitch) << name;
            EXPECT_EQ(file.provenance, full_provenance) << name;
        }
        for (std::size_t k = 0; k < map.height.values.size(); ++k) {
            const double z = map.height.values[k];
            const double tolerance = sur ? std::ldexp(1, -34) : std::abs(z) * (tiff ? std::ldexp(1, -23) : step);
            if (std::isnan(z))
                EXPECT_TRUE(std::isnan(file.map.height.values[k])) << name << " " << k;
            else
                EXPECT_NEAR(file.map.height.values[k], z, tolerance) << name << " " << k;
        }
    }
}

// In the bytes themselves, found without the readers, rows go from the top.
TEST_F(SurfaceFiles, TheLetterIsUprightInTheBytes) {
    const HeightMap map = letter_map();
    const auto as_text = [](std::size_t count, const std::function<double(std::size_t)>& metres) {
        std::string text;
        for (std::size_t k = 0; k < count; ++k) {
            const double mm = metres(k) * 1e3;
            text += std::isnan(mm) ? '?' : std::abs(mm - ink) < 1e-9 ? '#' : std::abs(mm - paper) < 1e-9 ? '.' : '!';
        }
        return text;
    };
    const std::string sdf = sdf_bytes(map, {});
    ASSERT_EQ(sdf.size(), 81 + 36 * 8u);
    EXPECT_EQ(as_text(36, [&](std::size_t k) { return at<double>(sdf, 81 + 8 * k); }), letter_text());
    const std::string sur = sur_bytes(map, {});
    ASSERT_EQ(sur.size(), 512 + 36 * 4u);
    const double step = static_cast<double>(at<float>(sur, 128));
    const int gap = at<std::int32_t>(sur, 100) - 2;
    EXPECT_EQ(as_text(36,
                      [&](std::size_t k) {
                          const int n = at<std::int32_t>(sur, 512 + 4 * k);
                          return n == gap ? nan : n * step / 1e3;
                      }),
              letter_text());
    // The wrong twin has rows that were not flipped.
    std::string upside_down;
    for (auto line = letter.rbegin(); line != letter.rend(); ++line)
        upside_down += *line;
    EXPECT_NE(letter_text(), upside_down);
    for (const std::string& name : read_back) {
        write_surface(folder_ / name, map);
        EXPECT_EQ(seen(read_surface(folder_ / name).map), letter_text()) << name;
    }
}

TEST_F(SurfaceFiles, PlyHoldsMeasuredPointsAndTheirTriangles) {
    write_surface(folder_ / "a.ply", letter_map(), {.creator = "vkfv"});
    const std::string bytes = bytes_of(folder_ / "a.ply");
    const auto end = bytes.find("end_header\n") + 11;
    EXPECT_THAT(bytes.substr(0, end), testing::HasSubstr("comment creator=vkfv\n"));
    EXPECT_THAT(bytes.substr(0, end), testing::HasSubstr("element vertex 35\n"));
    // There are 25 cells of two triangles; the gap is inside and takes part in six.
    EXPECT_THAT(bytes.substr(0, end), testing::HasSubstr("element face 44\n"));
    ASSERT_EQ(bytes.size(), end + 35 * 12 + 44 * 13u);
    const auto coordinate = [&](std::size_t vertex, std::size_t axis) {
        return static_cast<double>(at<float>(bytes, end + 12 * vertex + 4 * axis));
    };
    EXPECT_NEAR(coordinate(0, 0), -0.125, 1e-8);
    EXPECT_NEAR(coordinate(0, 1), 0.7, 1e-7);
    EXPECT_NEAR(coordinate(34, 1), 0.7 + 5 * 0.0031, 1e-7);
    EXPECT_NEAR(coordinate(34, 2), ink, 1e-9);
    double area = 0;
    for (std::size_t face = 0; face < 44; ++face) {
        const std::size_t start = end + 35 * 12 + 13 * face;
        EXPECT_EQ(bytes[start], 3);
        std::array<std::size_t, 3> corner;
        for (std::size_t k = 0; k < 3; ++k) {
            corner[k] = at<std::uint32_t>(bytes, start + 1 + 4 * k);
            ASSERT_LT(corner[k], 35u);
        }
        const double twice = (coordinate(corner[1], 0) - coordinate(corner[0], 0)) *
                                 (coordinate(corner[2], 1) - coordinate(corner[0], 1)) -
                             (coordinate(corner[1], 1) - coordinate(corner[0], 1)) *
                                 (coordinate(corner[2], 0) - coordinate(corner[0], 0));
        EXPECT_GT(twice, 0) << "counter-clockwise from +z";
        area += twice / 2;
    }
    EXPECT_NEAR(area, 22 * 0.00228 * 0.0031, 22 * 1e-7 * 0.004); // float32 coordinates near 0.7 mm
}

// --- X3P ---

std::string md5(const std::string& bytes) {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned int length = 0;
    EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_md5(), nullptr);
    std::string text;
    for (unsigned int k = 0; k < length; ++k) {
        constexpr const char* digits = "0123456789abcdef";
        text += digits[digest[k] >> 4];
        text += digits[digest[k] & 15];
    }
    return text;
}

using Entries = std::vector<std::pair<std::string, std::string>>;

Entries entries_of(const std::filesystem::path& path) {
    Entries entries;
    int error = 0;
    zip_t* archive = zip_open(path.c_str(), ZIP_RDONLY, &error);
    for (zip_int64_t k = 0; archive && k < zip_get_num_entries(archive, 0); ++k) {
        zip_stat_t stat;
        zip_stat_index(archive, static_cast<zip_uint64_t>(k), 0, &stat);
        std::string content(stat.size, '\0');
        zip_file_t* file = zip_fopen_index(archive, static_cast<zip_uint64_t>(k), 0);
        EXPECT_EQ(zip_fread(file, content.data(), content.size()), static_cast<zip_int64_t>(content.size()));
        zip_fclose(file);
        entries.emplace_back(stat.name, content);
    }
    zip_discard(archive);
    return entries;
}

void write_zip(const std::filesystem::path& path, const Entries& entries) {
    int error = 0;
    zip_t* archive = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &error);
    for (const auto& [name, content] : entries)
        zip_file_add(archive, name.c_str(), zip_source_buffer(archive, content.data(), content.size(), 0), 0);
    ASSERT_EQ(zip_close(archive), 0);
}

// An X3P file as other programs write it: 3 x 2 points, the first row on top.
struct ForeignX3p {
    std::string type = "F", revision = "ISO5436 \xE2\x80\x93 2000", cz, link = "bindata/data.bin", valid_link;
    std::string size_x = "3", size_y = "2", increment = "1e-6", points, valid, points_md5;

    std::string xml() const {
        return "<?xml version='1.0' encoding='UTF-8'?>\n<q:ISO5436_2 xmlns:q='http://www.opengps.eu/2008/ISO5436_2'>"
               "<Record1><Revision>" +
               revision +
               "</Revision><FeatureType>SUR</FeatureType><Axes>"
               "<CX><AxisType>I</AxisType><DataType>F</DataType><Increment>" +
               increment +
               "</Increment>"
               "<Offset>0</Offset></CX><CY><AxisType>I</AxisType><Increment>2e-6</Increment></CY>"
               "<CZ><AxisType>A</AxisType><DataType>" +
               type + "</DataType>" + cz +
               "</CZ></Axes></Record1>"
               "<Record3><MatrixDimension><SizeX>" +
               size_x + "</SizeX><SizeY>" + size_y +
               "</SizeY><SizeZ>1</SizeZ>"
               "</MatrixDimension><DataLink><PointDataLink>" +
               link + "</PointDataLink><MD5ChecksumPointData>" + points_md5 + "</MD5ChecksumPointData>" + valid_link +
               "</DataLink></Record3>"
               "<Record4><ChecksumFile>md5checksum.hex</ChecksumFile></Record4></q:ISO5436_2>";
    }
    Entries entries() const {
        Entries result = {{"main.xml", xml()}, {"bindata/data.bin", points}};
        if (!valid.empty())
            result.emplace_back("bindata/valid.bin", valid);
        return result;
    }
};

template <class Value>
std::string points_of(const std::vector<Value>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)};
}

TEST_F(SurfaceFiles, X3pOfEveryTypeIsRead) {
    const auto heights = [&](const ForeignX3p& x3p) {
        write_zip(folder_ / "foreign.x3p", x3p.entries());
        const HeightMap map = read_surface(folder_ / "foreign.x3p").map;
        EXPECT_DOUBLE_EQ(map.pitch_x, 1e-3);
        EXPECT_DOUBLE_EQ(map.pitch_y, 2e-3);
        std::vector<double> um;
        for (int row = map.rows() - 1; row >= 0; --row)
            for (int column = 0; column < map.columns(); ++column)
                um.push_back(map.height(column, row) * 1e3);
        return um;
    };
    const auto near = [](double value) { return testing::DoubleNear(value, 1e-9); };
    const auto gap = testing::IsNan();
    const float inf = std::numeric_limits<float>::infinity(), fnan = std::numeric_limits<float>::quiet_NaN();
    ForeignX3p x3p;
    x3p.points = points_of<float>({1e-6f, inf, -2e-6f, fnan, -inf, 0});
    // float32 of 2e-6 is off by at most 2^-25 of it.
    EXPECT_THAT(heights(x3p), testing::ElementsAre(testing::DoubleNear(1, 6e-8), gap, testing::DoubleNear(-2, 6e-8),
                                                   gap, gap, near(0)));
    x3p.type = "D";
    x3p.points = points_of<double>({1e-6, nan, -2e-6, 0, 3e-6, 4e-6});
    x3p.link = "./bindata/data.bin";
    EXPECT_THAT(heights(x3p), testing::ElementsAre(near(1), gap, near(-2), near(0), near(3), near(4)));
    // The file has signed integers with offset and increment, and a mask: bits 0, 2, 3 and 5.
    x3p.cz = "<Increment>1e-8</Increment><Offset>1e-6</Offset>";
    x3p.valid = std::string(1, '\x2d');
    x3p.valid_link = "<ValidPointsLink>bindata/valid.bin</ValidPointsLink><MD5ChecksumValidPoints>" + md5(x3p.valid) +
                     "</MD5ChecksumValidPoints>";
    x3p.type = "I";
    x3p.points = points_of<std::int16_t>({-100, 5, 100, -32768, 5, 32767});
    x3p.points_md5 = md5(x3p.points);
    EXPECT_THAT(heights(x3p), testing::ElementsAre(near(0), gap, near(2), near(-326.68), gap, near(328.67)));
    x3p.type = "L";
    x3p.points = points_of<std::int32_t>({-100, 5, 100, -100000, 5, 0});
    x3p.points_md5 = md5(x3p.points);
    EXPECT_THAT(heights(x3p), testing::ElementsAre(near(0), gap, near(2), near(-999), gap, near(1)));
}

TEST_F(SurfaceFiles, X3pStatesRightChecksumsAndVersionNeeded) {
    write_surface(folder_ / "a.x3p", letter_map(), full_provenance);
    const std::string bytes = bytes_of(folder_ / "a.x3p");
    EXPECT_EQ(bytes.substr(0, 5), std::string("PK\x03\x04\x14", 5));
    std::map<std::string, std::string> entries;
    for (const auto& [name, content] : entries_of(folder_ / "a.x3p"))
        entries[name] = content;
    ASSERT_EQ(entries.size(), 4u);
    EXPECT_EQ(entries["md5checksum.hex"], md5(entries["main.xml"]) + " *main.xml\n");
    EXPECT_LT(entries["main.xml"].find("ISO5436_2"), 4096u);
    pugi::xml_document document;
    ASSERT_TRUE(document.load_string(entries["main.xml"].c_str()));
    const auto link = document.child("p:ISO5436_2").child("Record3").child("DataLink");
    EXPECT_EQ(link.child_value("MD5ChecksumPointData"), md5(entries["bindata/data.bin"]));
    EXPECT_EQ(link.child_value("MD5ChecksumValidPoints"), md5(entries["bindata/valid.bin"]));
    EXPECT_EQ(entries["bindata/data.bin"].size(), 36 * 8u);
    // The mask has 36 bits, the gap at 3 * 6 + 4 = 22, which is bit 6 of byte 2.
    EXPECT_EQ(entries["bindata/valid.bin"], std::string("\xff\xff\xbf\xff\x0f"));
}

void expect_refused(const std::filesystem::path& path, const std::string& part) {
    try {
        (void)read_surface(path);
        ADD_FAILURE() << path << " was accepted";
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr(part));
        EXPECT_EQ(error.problem().where.file, path);
        EXPECT_FALSE(error.problem().remedy.empty());
    }
}

TEST_F(SurfaceFiles, X3pChecksumsAreChecked) {
    write_surface(folder_ / "a.x3p", letter_map());
    const Entries entries = entries_of(folder_ / "a.x3p");
    const auto with = [&](const std::string& name, const std::function<void(std::string&)>& change) {
        Entries changed = entries;
        for (auto& [entry, content] : changed)
            if (entry == name)
                change(content);
        write_zip(folder_ / "changed.x3p", changed);
        return folder_ / "changed.x3p";
    };
    expect_refused(with("bindata/data.bin", [](std::string& content) { content[7] ^= 1; }), "MD5 of bindata/data.bin");
    expect_refused(with("bindata/valid.bin", [](std::string& content) { content[0] ^= 1; }),
                   "MD5 of bindata/valid.bin");
    expect_refused(with("main.xml", [](std::string& content) { content += ' '; }), "MD5 of main.xml");
    // Stale sums are read where that is asked for, with a warning for each; others have none.
    const auto warnings = [&](const std::string& name) {
        const auto read =
            read_surface(with(name, [](std::string& content) { content += ' '; }), {}, Checksums::may_be_stale);
        EXPECT_EQ(read.map.height.values.size(), letter_map().height.values.size());
        return read.warnings;
    };
    ASSERT_EQ(warnings("main.xml").size(), 1u);
    EXPECT_THAT(warnings("main.xml")[0], testing::HasSubstr("main.xml does not have the MD5 checksum"));
    EXPECT_TRUE(warnings("none").empty());
    // Files whose md5checksum.hex holds the sum alone, or nothing, are read.
    EXPECT_NO_THROW((void)read_surface(with("md5checksum.hex", [](std::string& content) { content.resize(32); })));
    EXPECT_NO_THROW((void)read_surface(with("md5checksum.hex", [](std::string& content) { content.clear(); })));
    EXPECT_NO_THROW((void)read_surface(with("none", [](std::string&) {})));
}

TEST_F(SurfaceFiles, HostileX3pIsRefused) {
    ForeignX3p good;
    good.points = points_of<float>(std::vector<float>(6, 1e-6f));
    write_zip(folder_ / "good.x3p", good.entries());
    EXPECT_NO_THROW((void)read_surface(folder_ / "good.x3p"));
    const auto refused = [&](const std::function<void(ForeignX3p&)>& change, const std::string& part) {
        ForeignX3p x3p = good;
        change(x3p);
        write_zip(folder_ / "bad.x3p", x3p.entries());
        expect_refused(folder_ / "bad.x3p", part);
    };
    refused([](ForeignX3p& x) { x.size_x = "-3"; }, "SizeX = -3");
    refused([](ForeignX3p& x) { x.size_x = "2147483648"; }, "2147483648 x 2 points");
    refused([](ForeignX3p& x) { x.size_x = x.size_y = "4294967296"; }, "points");
    refused([](ForeignX3p& x) { x.size_x = "0"; }, "0 x 2 points");
    refused([](ForeignX3p& x) { x.size_x = "16384", x.size_y = "16384"; }, "2147483648 bytes of heights in a file of");
    refused([](ForeignX3p& x) { x.increment = "NaN"; }, "Increment = NaN");
    refused([](ForeignX3p& x) { x.increment = "0"; }, "positive spacing");
    refused([](ForeignX3p& x) { x.increment = "-1e-6"; }, "positive spacing");
    refused([](ForeignX3p& x) { x.increment = ""; }, "Increment = nothing");
    refused([](ForeignX3p& x) { x.type = "Q"; }, "I, L, F or D");
    refused([](ForeignX3p& x) { x.cz = "<Increment>0</Increment>"; }, "CZ.Increment");
    refused([](ForeignX3p& x) { x.link = "elsewhere.bin"; }, "no such entry");
    refused([](ForeignX3p& x) { x.points.pop_back(); }, "23 bytes");
    refused([](ForeignX3p& x) { x.points_md5 = "00"; }, "MD5");
    refused([](ForeignX3p& x) { x.valid_link = "<ValidPointsLink>v.bin</ValidPointsLink>"; }, "v.bin");
    // A bomb packs 64 MiB in 64 kB; it is cut off at the 24 bytes that the header's points need.
    refused([](ForeignX3p& x) { x.points.resize(std::size_t{1} << 26); }, "more than 24 bytes");
    write_zip(folder_ / "bad.x3p", {{"other.xml", "<a/>"}});
    expect_refused(folder_ / "bad.x3p", "main.xml");
    write_zip(folder_ / "bad.x3p", {{"main.xml", "<a>"}});
    expect_refused(folder_ / "bad.x3p", "XML");
}

// Elements are nested half a million deep: neither reading nor forgetting them takes more of a stack.
TEST_F(SurfaceFiles, DeepXmlOfX3pIsReadOnASmallStack) {
    constexpr int depth = 500000;
    ForeignX3p deep;
    deep.points = points_of<float>(std::vector<float>(6, 1e-6f));
    deep.revision.clear();
    for (int k = 0; k < depth; ++k)
        deep.revision += "<a>";
    for (int k = 0; k < depth; ++k)
        deep.revision += "</a>";
    const auto path = folder_ / "deep.x3p";
    write_zip(path, deep.entries());
    int columns = 0;
    const std::function<void()> read = [&] { columns = read_surface(path).map.columns(); };
    pthread_attr_t small;
    pthread_attr_init(&small);
    pthread_attr_setstacksize(&small, 256 << 10);
    pthread_t thread;
    const auto run = [](void* work) -> void* { return (*static_cast<const std::function<void()>*>(work))(), nullptr; };
    ASSERT_EQ(pthread_create(&thread, &small, run, const_cast<std::function<void()>*>(&read)), 0);
    pthread_join(thread, nullptr);
    pthread_attr_destroy(&small);
    EXPECT_EQ(columns, 3);
}

// --- SUR ---

template <class Value>
std::string with(std::string bytes, std::size_t offset, Value value) {
    std::memcpy(bytes.data() + offset, &value, sizeof value);
    return bytes;
}

std::string with_text(std::string bytes, std::size_t offset, const std::string& text, std::size_t length) {
    return bytes.replace(offset, length, text + std::string(length - text.size(), '\0'));
}

TEST_F(SurfaceFiles, SurOf16BitsInOtherUnitsIsRead) {
    // The header has micrometres with the sign of Latin-1, NULs after the names, an offset, special points, a comment
    // and a private zone.
    std::string bytes = sur_bytes(letter_map(), {}).substr(0, 512);
    bytes = with(bytes, 98, std::int16_t{16});
    bytes = with(with(with(bytes, 108, std::int32_t{3}), 112, std::int32_t{2}), 116, std::int32_t{6});
    bytes = with(with(bytes, 86, std::int16_t{1}), 100, std::int32_t{-5});
    bytes = with(with(with(bytes, 120, 0.5f), 124, 2.0f), 128, 0.25f);
    bytes = with_text(with_text(with_text(bytes, 180, "\xB5m", 16), 196, "nm", 16), 212, "\xC2\xB5m", 16);
    bytes = with(with(bytes, 334, std::int16_t{5}), 336, std::int16_t{3});
    bytes = with(with(with(bytes, 466, 10.0f), 470, -20.0f), 474, 100.0f);
    const std::array<std::int16_t, 6> date = {58, 40, 13, 9, 6, 2009};
    std::memcpy(bytes.data() + 306, date.data(), sizeof date);
    const std::string zones = "hello" + std::string(3, '\1');
    const std::string points = points_of<std::int16_t>({4, -7, 8, 0, -5, 1});
    const auto check = [](const SurfaceFile& file) {
        EXPECT_DOUBLE_EQ(file.map.pitch_x, 0.5e-3);
        EXPECT_DOUBLE_EQ(file.map.pitch_y, 2e-6);
        EXPECT_DOUBLE_EQ(file.map.x0, 0.01);
        EXPECT_DOUBLE_EQ(file.map.y0, -2e-5);
        EXPECT_EQ(file.provenance.comment, "hello");
        EXPECT_EQ(file.provenance.date, "2009-06-09T13:40:58Z");
        const std::vector<double> um = {100, 98.75, 100.25, 101, nan, 102}; // lowest row first
        for (std::size_t k = 0; k < 6; ++k)
            if (std::isnan(um[k]))
                EXPECT_TRUE(std::isnan(file.map.height.values[k]));
            else
                EXPECT_NEAR(file.map.height.values[k], um[k] * 1e-3, 1e-12);
    };
    check(read_surface(write("a.sur", bytes + zones + points)));

    // The pixels may be packed by zlib, here in two streams.
    const auto stream = [](const std::string& part) {
        std::string packed(100, '\0');
        uLongf length = packed.size();
        EXPECT_EQ(compress(reinterpret_cast<Bytef*>(packed.data()), &length,
                           reinterpret_cast<const Bytef*>(part.data()), part.size()),
                  Z_OK);
        return packed.substr(0, length);
    };
    const std::string one = stream(points.substr(0, 8)), two = stream(points.substr(8));
    const auto size = [](std::size_t value) { return raw(static_cast<std::uint32_t>(value)); };
    const std::string directory = size(2) + size(8) + size(one.size()) + size(4) + size(two.size());
    const std::string packed = "DSCOMPRESSED" + bytes.substr(12) + zones;
    check(read_surface(write("packed.sur", packed + directory + one + two)));

    expect_refused(write("bad.sur", packed + directory + one), "packed points");
    expect_refused(write("bad.sur", packed + size(0xffffffff)), "directory");
    expect_refused(write("bad.sur", packed + size(1) + size(0xffffffff) + size(one.size()) + one), "4294967295 bytes");
    expect_refused(write("bad.sur", packed + size(1) + size(12) + size(one.size()) + one), "zlib");
    expect_refused(write("bad.sur", packed + directory + std::string(one.size() + two.size(), 'x')), "zlib");
}

TEST_F(SurfaceFiles, HostileSurIsRefused) {
    const std::string good = sur_bytes(letter_map(), {});
    const auto refused = [&](const std::string& bytes, const std::string& part) {
        expect_refused(write("bad.sur", bytes), part);
    };
    for (const std::size_t length : {std::size_t{12}, std::size_t{511}, std::size_t{512}, good.size() - 1})
        refused(good.substr(0, length), "bytes");
    refused(with(good, 108, std::int32_t{-6}), "0 x 6 points");
    refused(with(with(good, 108, std::int32_t{65536}), 112, std::int32_t{32768}), "65536 x 32768 points");
    refused(with(good, 112, std::int32_t{1 << 20}), "bytes from here on");
    const std::string packed = "DSCOMPRESSED" + good.substr(12);
    refused(with(with(packed, 108, std::int32_t{16384}), 112, std::int32_t{16384}),
            "2147483648 bytes of heights in a file of");
    refused(with(good, 120, std::numeric_limits<float>::quiet_NaN()), "spacing along x");
    refused(with(good, 124, 0.0f), "spacing along y");
    refused(with(good, 128, 0.0f), "step of z");
    refused(with(good, 98, std::int16_t{8}), "bits a point");
    refused(with(good, 18, std::int16_t{4}), "a surface");
    refused(with_text(good, 212, "V", 16), "unit of length");
    refused(with(good, 334, std::int16_t{32767}), "bytes");
}

// --- SDF ---

TEST_F(SurfaceFiles, SdfOfEveryTypeIsRead) {
    const auto heights = [&](int type, const std::string& points) {
        std::string bytes = sdf_bytes(letter_map(), {}).substr(0, 81);
        bytes = with(with(bytes, 42, std::uint16_t{2}), 44, std::uint16_t{2});
        bytes = with(with(bytes, 62, 1e-6), 79, static_cast<std::uint8_t>(type));
        const HeightMap map = read_surface(write("a.sdf", bytes + points)).map;
        std::vector<double> um;
        for (int row = 1; row >= 0; --row)
            for (int column = 0; column < 2; ++column)
                um.push_back(map.height(column, row) * 1e3);
        return um;
    };
    const auto are = testing::ElementsAre(testing::DoubleNear(1, 1e-12), testing::IsNan(),
                                          testing::DoubleNear(-2, 1e-12), testing::DoubleNear(0, 0));
    EXPECT_THAT(heights(3, points_of<float>({1, std::numeric_limits<float>::infinity(), -2, 0})), are);
    EXPECT_THAT(heights(5, points_of<std::int16_t>({1, std::numeric_limits<std::int16_t>::min(), -2, 0})), are);
    EXPECT_THAT(heights(6, points_of<std::int32_t>({1, std::numeric_limits<std::int32_t>::min(), -2, 0})), are);
    EXPECT_THAT(heights(7, points_of<double>({1, nan, -2, 0})), are);
}

std::string sdf_of(const std::string& points, const std::string& profiles, const std::string& heights) {
    return "aISO-1.0\r\nManufacID = someone\r\nCreateDate = 090620091340\r\nModDate = 090620091340\r\nNumPoints = " +
           points + "\r\nNumProfiles = " + profiles +
           "\r\nXscale = 1.0E-6\r\nYscale = +2e-6\r\nZscale = 1e-6\r\nZresolution = -1\r\n"
           "Compression = 0\r\nDataType = 7\r\nCheckType = 0\r\n*\r\n" +
           heights;
}

TEST_F(SurfaceFiles, SdfTextIsRead) {
    const SurfaceFile file =
        read_surface(write("a.sdf", sdf_of("3", "2", "1.5 BAD\t-2\r\n 3 4e0\n5\r\n*\r\n<Operator> x\r\n*")));
    EXPECT_DOUBLE_EQ(file.map.pitch_x, 1e-3);
    EXPECT_DOUBLE_EQ(file.map.pitch_y, 2e-3);
    EXPECT_EQ(file.provenance.manufacturer, "someone");
    EXPECT_EQ(file.provenance.date, "2009-06-09T13:40:00Z");
    EXPECT_EQ(file.provenance.comment, "<Operator> x");
    EXPECT_NEAR(file.map.height(0, 1), 1.5e-3, 1e-15);
    EXPECT_TRUE(std::isnan(file.map.height(1, 1)));
    EXPECT_NEAR(file.map.height(0, 0), 3e-3, 1e-15);
    EXPECT_NEAR(file.map.height(2, 0), 5e-3, 1e-15);
}

TEST_F(SurfaceFiles, HostileSdfIsRefused) {
    const std::string good = sdf_bytes(letter_map(), {});
    const auto refused = [&](const std::string& bytes, const std::string& part) {
        expect_refused(write("bad.sdf", bytes), part);
    };
    refused(good.substr(0, 80), "header");
    refused(good.substr(0, good.size() - 1), "points");
    refused(with(with(good, 42, std::uint16_t{65535}), 44, std::uint16_t{65535}), "65535 x 65535 points");
    refused(with(good, 42, std::uint16_t{0}), "0 x 6 points");
    refused(with(good, 46, nan), "Xscale");
    refused(with(good, 54, -1.0), "Yscale");
    refused(with(good, 62, 0.0), "Zscale");
    refused(with(good, 79, std::uint8_t{9}), "data type");
    refused(with(good, 78, std::uint8_t{1}), "compression");
    refused(sdf_of("-3", "2", "1 2 3 4 5 6\n*"), "NumPoints = -3");
    refused(sdf_of("2147483648", "1", "1 2\n*"), "2147483648 x 1 points");
    refused(sdf_of("10000", "10000", "1 2\n*"), "10000 x 10000 heights");
    refused(sdf_of("3", "2", "1 2 3 4 5\n*     "), "the end of profile 1");
    refused(sdf_of("3", "2", "1 2 3 4 5 ").substr(0, 100), "a line with *");
}

// --- AL3D ---

std::string al3d(const std::string& rows = "2", const std::string& offset = "489", const std::string& gap_text = "-1",
                 float gap = -1) {
    const auto tag = [](std::string key, std::string value) {
        key.resize(20, '\0');
        value.resize(30, '\0');
        return key + value + "\r\n";
    };
    std::string bytes("AliconaImaging\0\r\n", 17);
    bytes += tag("Version", "1") + tag("TagCount", "7") + tag("Rows", rows) + tag("Cols", "3") +
             tag("PixelSizeXMeter", "1e-06") + tag("PixelSizeYMeter", "2e-06") + tag("DepthImageOffset", offset) +
             tag("InvalidPixelValue", gap_text) + tag("Comment", "none");
    bytes.resize(489, '\0');
    return bytes + points_of<float>({1e-6f, gap, 2e-6f, 9, 3e-6f, std::numeric_limits<float>::quiet_NaN(), 5e-6f, 9});
}

TEST_F(SurfaceFiles, Al3dIsRead) {
    const HeightMap map = read_surface(write("a.al3d", al3d())).map;
    ASSERT_EQ(map.columns(), 3);
    ASSERT_EQ(map.rows(), 2);
    EXPECT_DOUBLE_EQ(map.pitch_x, 1e-3);
    EXPECT_DOUBLE_EQ(map.pitch_y, 2e-3);
    // The file has metres in float32; rows are padded to 16 bytes, the first on top.
    EXPECT_NEAR(map.height(0, 1), 1e-3, 6e-11);
    EXPECT_TRUE(std::isnan(map.height(1, 1)));
    EXPECT_NEAR(map.height(2, 1), 2e-3, 6e-11);
    EXPECT_NEAR(map.height(0, 0), 3e-3, 2e-10);
    EXPECT_TRUE(std::isnan(map.height(1, 0)));
    EXPECT_NEAR(map.height(2, 0), 5e-3, 3e-10);
}

TEST_F(SurfaceFiles, GapsOfAl3dAreFoundThoughTheirValueIsRounded) {
    constexpr float largest = std::numeric_limits<float>::max();
    for (const char* text : {"3.402823e+38", "3.4028e+38", "0"}) {
        const HeightMap map = read_surface(write("a.al3d", al3d("2", "489", text, largest))).map;
        EXPECT_TRUE(std::isnan(map.height(1, 1))) << text;
        EXPECT_NEAR(map.height(2, 1), 2e-3, 6e-11);
    }
}

TEST_F(SurfaceFiles, HostileAl3dIsRefused) {
    expect_refused(write("bad.al3d", al3d().substr(0, 300)), "tag");
    expect_refused(write("bad.al3d", al3d().substr(0, 510)), "DepthImageOffset");
    expect_refused(write("bad.al3d", al3d("2147483648")), "2147483648 points");
    expect_refused(write("bad.al3d", al3d("-2")), "Rows = -2");
    expect_refused(write("bad.al3d", al3d("10000000")), "DepthImageOffset");
    expect_refused(write("bad.al3d", al3d("2", "18446744073709551615")), "DepthImageOffset");
}

// --- images ---

// Surfaces without a date get that of SOURCE_DATE_EPOCH, 2023-11-14T22:13:00Z here (SDF counts in minutes), and others
// keep their own.
TEST_F(SurfaceFiles, TheEnvironmentDatesSurfacesThatHaveNoDate) {
    const auto date_of = [&](const Provenance& provenance, const char* ending) {
        const auto file = folder_ / (std::string("dated") + ending);
        std::ofstream(file, std::ios::binary) << surface_bytes(file, letter_map(), provenance);
        return read_surface(file).provenance.date;
    };
    for (const char* ending : {".x3p", ".sdf", ".gsf"}) {
        ::setenv("SOURCE_DATE_EPOCH", "1699999980", 1);
        EXPECT_EQ(date_of({}, ending), "2023-11-14T22:13:00Z") << ending;
        EXPECT_EQ(date_of({.date = "2024-02-29T01:02:00Z"}, ending), "2024-02-29T01:02:00Z") << ending;
        for (const char* wrong : {"", "-1", "tomorrow", "1700000000x", "99999999999999"}) {
            ::setenv("SOURCE_DATE_EPOCH", wrong, 1);
            EXPECT_EQ(date_of({}, ending), "") << ending << wrong;
        }
        ::unsetenv("SOURCE_DATE_EPOCH");
        EXPECT_EQ(date_of({}, ending), "") << ending;
    }
}

TEST_F(SurfaceFiles, ForeignImagesNeedTheirScale) {
    Grid<float> values(2, 2);
    values.values = {1, 2, std::numeric_limits<float>::infinity(), 4};
    write_tiff(folder_ / "foreign.tif", values);
    const SurfaceFile file = read_surface(folder_ / "foreign.tif", {.pitch = 0.5, .unit = 1e-3});
    EXPECT_EQ(file.map.pitch_x, 0.5);
    EXPECT_DOUBLE_EQ(file.map.height(1, 0), 2e-3);
    EXPECT_TRUE(std::isnan(file.map.height(0, 1)));
    EXPECT_THROW((void)read_surface(folder_ / "foreign.tif"), InputError);
    EXPECT_THROW((void)read_surface(folder_ / "foreign.tif", {.pitch = 0.5, .unit = {}}), InputError);
    EXPECT_THROW((void)read_surface(folder_ / "foreign.tif", {.pitch = nan, .unit = 1}), InputError);
    // A file's own scale stands.
    write_surface(folder_ / "own.tif", letter_map());
    write_surface(folder_ / "own.x3p", letter_map());
    EXPECT_THROW((void)read_surface(folder_ / "own.tif", {.pitch = 0.5, .unit = {}}), InputError);
    EXPECT_THROW((void)read_surface(folder_ / "own.x3p", {.pitch = {}, .unit = 1}), InputError);
}

TEST_F(SurfaceFiles, NeitherUnknownFilesNorNames) {
    expect_refused(folder_ / "missing.x3p", "no such file");
    expect_refused(folder_, "a directory");
    expect_refused(write("empty.x3p", ""), "unknown kind");
    expect_refused(write("text.x3p", "not a surface"), "unknown kind");
    expect_refused(write("a.datx", "\x89HDF\r\n\x1a\n"), "an HDF5 file");
    expect_refused(write("depth.png", "\x89PNG\r\n\x1a\n"), "a picture (PNG)");
    expect_refused(write("depth.jpg", "\xff\xd8\xff\xe0"), "a picture (JPEG)");
    EXPECT_THROW(write_surface(folder_ / "a.png", letter_map()), InputError);
    EXPECT_THROW(write_surface(folder_ / "none" / "a.x3p", letter_map()), RunError);
    HeightMap wide = letter_map();
    wide.height = Grid<double>(65536, 1);
    EXPECT_THROW(write_surface(folder_ / "a.sdf", wide), RunError);
    HeightMap high = letter_map();
    high.height(0, 0) = 1e60;
    EXPECT_THROW(write_surface(folder_ / "a.sur", high), RunError);
    // The content counts, not the name.
    write_surface(folder_ / "a.x3p", letter_map());
    std::filesystem::rename(folder_ / "a.x3p", folder_ / "a.sur");
    EXPECT_EQ(seen(read_surface(folder_ / "a.sur").map), letter_text());
}

} // namespace
} // namespace vkfv::surface
