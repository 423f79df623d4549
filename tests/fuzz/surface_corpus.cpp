// Writes the corpus of the surface readers' fuzzers into a folder: small whole files of every format, truncated files,
// and files with headers that lie.
#include "support/instrument_files.hpp"
#include "support/surface_files.hpp"
#include "surface/exr_bytes.hpp"
#include "surface_files/surface_file.hpp"

#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <utility>

namespace {

using namespace vkfv::surface;
using namespace std::string_literals;
namespace fs = std::filesystem;

std::string bytes_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void write(const fs::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

template <class Value>
std::string with(std::string bytes, std::size_t offset, Value value) {
    std::memcpy(bytes.data() + offset, &value, sizeof value);
    return bytes;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
}

void write_cuts(const fs::path& folder, const std::string& name, const std::string& bytes) {
    for (const int part : {0, 1, 2, 3})
        write(folder / (name + "_cut" + std::to_string(part)), bytes.substr(0, bytes.size() * (2 * part + 1) / 8));
}

HeightMap wave(bool gaps) {
    HeightMap map;
    map.height = vkfv::Grid<double>(5, 4);
    map.pitch_x = 0.002;
    map.pitch_y = 0.003;
    map.x0 = -0.5;
    map.y0 = 0.25;
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column)
            map.height(column, row) = gaps && (row * column) % 4 == 3 ? std::numeric_limits<double>::quiet_NaN()
                                                                      : 1e-3 * std::sin(column + 2.3 * row);
    return map;
}

std::string al3d() {
    const auto tag = [](std::string key, std::string value) {
        key.resize(20, '\0');
        value.resize(30, '\0');
        return key + value + "\r\n";
    };
    std::string bytes("AliconaImaging\0\r\n", 17);
    bytes += tag("Version", "1") + tag("TagCount", "6") + tag("Rows", "2") + tag("Cols", "3") +
             tag("PixelSizeXMeter", "1e-06") + tag("PixelSizeYMeter", "2e-06") + tag("DepthImageOffset", "436") +
             tag("InvalidPixelValue", "-1");
    bytes.resize(436, '\0');
    for (const float metres : {1e-6f, -1.0f, 2e-6f, 0.0f, 3e-6f, 4e-6f, 5e-6f, 0.0f})
        bytes.append(reinterpret_cast<const char*>(&metres), sizeof metres);
    return bytes;
}

} // namespace

int main(int argument_count, char** arguments) {
    if (argument_count != 2) {
        std::fputs("usage: surface_corpus FOLDER\n", stderr);
        return 2;
    }
    const fs::path root = arguments[1];
    const Provenance provenance{.creator = "vkfv",
                                .manufacturer = "none",
                                .model = "virtual",
                                .serial = "1",
                                .version = "2",
                                .date = "2026-01-31T12:34:56Z",
                                .comment = "two\nlines"};
    for (const char* reader : {"x3p", "sur", "sdf", "al3d", "height_image", "height_table", "gsf", "gwy", "npy", "opd",
                               "metropro", "zygo_text", "nms", "plu"})
        fs::create_directories(root / reader);
    const auto whole = [&](const char* reader, const std::string& name, bool gaps) {
        write_surface(root / reader / name, wave(gaps), provenance);
        const std::string bytes = bytes_of(root / reader / name);
        write_cuts(root / reader, name, bytes);
        return bytes;
    };

    whole("x3p", "full.x3p", false);
    const std::string x3p = whole("x3p", "gaps.x3p", true);
    write(root / "x3p" / "flipped", with(x3p, x3p.size() / 2, '\xff'));

    // The fuzzer packs the archive itself: main.xml, NUL, points.
    write(root / "x3p" / "main", std::string("<p:ISO5436_2 xmlns:p='http://www.opengps.eu/2008/ISO5436_2'><Record1>"
                                             "<FeatureType>SUR</FeatureType><Axes><CX><AxisType>I</AxisType><Increment>"
                                             "1e-6</Increment></CX><CY><AxisType>I</AxisType><Increment>2e-6"
                                             "</Increment></CY><CZ><DataType>I</DataType><Increment>1e-9</Increment>"
                                             "</CZ></Axes></Record1><Record3><MatrixDimension><SizeX>3</SizeX><SizeY>"
                                             "2</SizeY><SizeZ>1</SizeZ></MatrixDimension><DataLink><PointDataLink>"
                                             "bindata/data.bin</PointDataLink></DataLink></Record3></p:ISO5436_2>") +
                                     std::string("\0abcdefghijkl", 13));

    whole("sur", "full.sur", false);
    const std::string sur = whole("sur", "gaps.sur", true);
    constexpr std::int32_t largest = std::numeric_limits<std::int32_t>::max();
    write(root / "sur" / "columns_negative", with(sur, 108, std::int32_t{-1}));
    write(root / "sur" / "points_2_31", with(with(sur, 108, std::int32_t{1 << 16}), 112, std::int32_t{1 << 15}));
    write(root / "sur" / "rows_largest", with(sur, 112, largest));
    write(root / "sur" / "pitch_nan", with(sur, 120, std::numeric_limits<float>::quiet_NaN()));
    write(root / "sur" / "pitch_zero", with(sur, 120, 0.0f));
    write(root / "sur" / "short_points", with(sur, 98, std::int16_t{16}));
    write(root / "sur" / "packed", "DSCOMPRESSED" + sur.substr(12));

    whole("sdf", "full.sdf", false);
    const std::string sdf = whole("sdf", "gaps.sdf", true);
    whole("sdf", "full.asc.sdf", false);
    const std::string text = whole("sdf", "gaps.asc.sdf", true);
    write(root / "sdf" / "points_65535", with(with(sdf, 42, std::uint16_t{65535}), 44, std::uint16_t{65535}));
    write(root / "sdf" / "pitch_nan", with(sdf, 46, std::numeric_limits<double>::quiet_NaN()));
    write(root / "sdf" / "scale_zero", with(sdf, 62, 0.0));
    for (const int type : {3, 5, 6})
        write(root / "sdf" / ("type" + std::to_string(type)), with(sdf, 79, static_cast<std::uint8_t>(type)));
    write(root / "sdf" / "text_negative", replaced(text, "NumPoints = 5", "NumPoints = -5"));
    write(root / "sdf" / "text_2_31", replaced(text, "NumPoints = 5", "NumPoints = 2147483648"));
    write(root / "sdf" / "text_bad", replaced(text, "NaN", "BAD"));

    write(root / "al3d" / "whole", al3d());
    write_cuts(root / "al3d", "whole", al3d());
    // The values of the third and the second tag are replaced.
    write(root / "al3d" / "rows_2_31", al3d().replace(17 + 2 * 52 + 20, 10, "2147483648"));
    write(root / "al3d" / "tags_many", al3d().replace(17 + 52 + 20, 8, "99999999"));

    const std::string gsf = whole("gsf", "gaps.gsf", true);
    write(root / "gsf" / "columns_2_31", replaced(gsf, "XRes = 5", "XRes = 2147483648"));
    write(root / "gsf" / "unit_nm", replaced(gsf, "XYUnits = m", "XYUnits = nm"));
    whole("gwy", "full.gwy", false);
    const std::string gwy = whole("gwy", "gaps.gwy", true);
    const auto columns_of_gwy = gwy.find("xres") + 6, points_of_gwy = gwy.find("data\0D"s) + 6;
    write(root / "gwy" / "columns_largest", with(gwy, columns_of_gwy, std::numeric_limits<std::int32_t>::max()));
    write(root / "gwy" / "points_largest", with(gwy, points_of_gwy, 0xffffffffu));
    const std::string npy = whole("npy", "gaps.npy", true);
    write(root / "npy" / "columns_2_31", replaced(npy, "5)", "2147483648)"));
    write(root / "npy" / "by_columns", replaced(npy, "False", "True "));
    write(root / "npy" / "integers", replaced(npy, "<f8", ">i2"));
    whole("height_table", "gaps.csv", true);
    write(root / "height_table" / "points", "0,0,1\n1,0,2\n0,1,3\n1,1,4\n");
    write(root / "height_table" / "decimal_commas", "1,5;2\n3;4,25\n");
    write(root / "height_table" / "far", "# Width: 2 nm\n# Height: 3 nm\n# Value units: m\n1e-6 2e-6\n1e34 4e-6\n");
    write(root / "height_table" / "gwyddion", "# Width: 2 nm\n# Height: 3 nm\n# Value units: m\n1e-6 2e-6\n* 4e-6\n");
    for (const auto& [reader, ending] :
         {std::pair{"opd", "opd"}, {"metropro", "dat"}, {"nms", "nms"}, {"plu", "plu"}}) {
        const std::string bytes = vkfv::test::instrument_file(ending);
        write(root / reader / "whole", bytes);
        write_cuts(root / reader, "whole", bytes);
    }
    for (const auto& [name, text] :
         {std::pair{"phases", vkfv::test::zygo_phases()}, {"points", vkfv::test::zygo_points()}}) {
        write(root / "zygo_text" / name, text);
        write_cuts(root / "zygo_text", name, text);
    }
    write(root / "plu" / "rows_largest", with(vkfv::test::plu_file(), 500, 0xffffffffu));
    write(root / "nms" / "offset_largest", with(vkfv::test::nms_file(), 1352, 0xffffffffu));
    write(root / "opd" / "directory_largest", with(vkfv::test::opd_file(), 20, 0xffffffffu));
    write(root / "metropro" / "intensities_largest", with(vkfv::test::metropro_file(), 60, 0xffffffffu));

    whole("height_image", "full.tif", false);
    const std::string tiff = whole("height_image", "gaps.tif", true);
    write(root / "height_image" / "foreign.tif", replaced(tiff, "vkfv height map", "other height map"));
    using vkfv::test::ExrBytes;
    const std::string exr = ExrBytes{}.bytes();
    write(root / "height_image" / "lines.exr", exr);
    write_cuts(root / "height_image", "lines.exr", exr);
    write(root / "height_image" / "tiles.exr", ExrBytes{.tile = 2}.bytes());
    write(root / "height_image" / "parts.exr", ExrBytes{.parts = 2}.bytes());
    write(root / "height_image" / "parts_of_tiles.exr", ExrBytes{.tile = 2, .parts = 2}.bytes());
    write(root / "height_image" / "chunks_many.exr", ExrBytes{.parts = 2, .chunks = largest}.bytes());
    write(root / "height_image" / "window_2_20.exr", ExrBytes{.window = {0, 0, 2, 1 << 20}}.bytes());
    write(root / "height_image" / "window_largest.exr", ExrBytes{.window = {0, 0, largest, largest}}.bytes());
    write(root / "height_image" / "window_negative.exr", ExrBytes{.window = {2, 1, 0, 0}}.bytes());
    write(root / "height_image" / "tile_largest.exr", ExrBytes{.tile = 0xffffffff}.bytes());
    const std::string tiled = ExrBytes{.tile = 2}.bytes();
    constexpr std::string_view tiles("tiledesc\0", 9);
    write(root / "height_image" / "tile_high.exr", with(tiled, tiled.find(tiles) + tiles.size() + 8, 0x7b20002u));
    constexpr std::string_view compression("compression\0compression\0", 24);
    write(root / "height_image" / "attribute_long.exr",
          with(exr, exr.find(compression) + compression.size() + 2, 0x68));
    const auto description = tiff.find("vkfv height map");
    write(root / "height_image" / "own.exr",
          ExrBytes{.description = tiff.substr(description, tiff.find('\0', description) - description)}.bytes());
    return 0;
}
