// The values of every format that is read, by every route on which images come in, are those of the picture that was
// written. Files are smaller and larger than 4096 bytes, a block of C's streams: readers once began behind that block.
#include "app/program.hpp"
#include "core/messages/error.hpp"
#include "images/image_file.hpp"
#include "scan/image_series.hpp"
#include "specimen/files.hpp"
#include "specimen/reflectance.hpp"
#include "support/surface_files.hpp"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <tiffio.h>
#include <zlib.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <random>
#include <thread>

namespace vkfv::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// Grey values 0 to 255 as they are seen, the first row on top.
struct Picture {
    int columns = 0;
    int rows = 0;
    std::vector<int> values{};

    int at(int column, int row) const { return values.at(static_cast<std::size_t>(row * columns + column)); }
};

// A picture of smooth shades, since lossy formats keep these best, with a corner that no mirrored picture has.
Picture smooth(int columns, int rows) {
    Picture picture{.columns = columns, .rows = rows};
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            picture.values.push_back(20 + 150 * column / columns + 60 * row / rows);
        }
    }
    return picture;
}

// A picture of noise, which no packing makes small.
Picture noisy(int columns, int rows) {
    Picture picture = smooth(columns, rows);
    std::mt19937 random(5);
    for (int& value : picture.values) {
        value += static_cast<int>(random() % 25);
    }
    return picture;
}

// The picture as a file holds it whose orientation is this (TIFF 6.0, tag 274): for 1 to 8 the stored first row is the
// picture's top, top, bottom, bottom, left, right, right, left side, the first column its left, right, right, left,
// top, top, bottom, bottom side.
Picture stored_as(const Picture& seen, int orientation) {
    const bool rows_are_columns = orientation >= 5;
    Picture stored{.columns = rows_are_columns ? seen.rows : seen.columns,
                   .rows = rows_are_columns ? seen.columns : seen.rows};
    const std::string row_from = " ttbblrrl", column_from = " lrrlttbb";
    const auto line = static_cast<std::size_t>(orientation);
    for (int row = 0; row < stored.rows; ++row) {
        for (int column = 0; column < stored.columns; ++column) {
            std::map<char, int> from = {{row_from[line], row}, {column_from[line], column}};
            const int x = from.contains('l') ? from['l'] : seen.columns - 1 - from['r'];
            const int y = from.contains('t') ? from['t'] : seen.rows - 1 - from['b'];
            stored.values.push_back(seen.at(x, y));
        }
    }
    return stored;
}

using Write = std::function<void(const fs::path&, const Picture&)>;

// A format of images, or a variant of one, and how to write it.
struct Kind {
    std::string name; // of the file
    Write write;
    double white = 255;   // the value that 255 is stored as
    double tolerance = 0; // error of the format itself, where white is 255
    bool grey = true;     // colours of lossy formats need not be
};

// --- Writers

template <class Value>
std::vector<Value> scaled(const Picture& picture, double white, int channels) {
    std::vector<Value> values;
    for (const int value : picture.values) {
        values.insert(values.end(), static_cast<std::size_t>(channels), static_cast<Value>(value * white / 255));
    }
    return values;
}

struct ByLibrary {
    const char* format;
    OIIO::TypeDesc type = OIIO::TypeDesc::UINT8;
    double white = 255;
    int channels = 1;
    std::map<std::string, std::string> words{};
    std::map<std::string, int> numbers{};
};

void write_by_library(const fs::path& path, const Picture& picture, const ByLibrary& how) {
    const auto output = OIIO::ImageOutput::create(how.format);
    ASSERT_TRUE(output) << OIIO::geterror();
    OIIO::ImageSpec spec(picture.columns, picture.rows, how.channels, how.type);
    for (const auto& [name, value] : how.words) {
        spec.attribute(name, value);
    }
    for (const auto& [name, value] : how.numbers) {
        name == "tile" ? spec.tile_width = spec.tile_height = value : (spec.attribute(name, value), 0);
    }
    const auto values = scaled<double>(picture, 1, how.channels); // values from 0 to 1, the library's white
    ASSERT_TRUE(output->open(path.string(), spec)) << output->geterror();
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::DOUBLE, values.data())) << output->geterror();
    ASSERT_TRUE(output->close()) << output->geterror();
}

Kind by_library(std::string name, const ByLibrary& how, double tolerance = 0) {
    return {.name = std::move(name),
            .write = [how](const fs::path& path, const Picture& picture) { write_by_library(path, picture, how); },
            .white = how.white,
            .tolerance = tolerance};
}

// A format that libtiff writes and OpenImageIO does not. mode: "wb" is big-endian, "wl8" a little-endian BigTIFF.
Kind by_libtiff(std::string name, const char* mode, int bits, int photometric = PHOTOMETRIC_MINISBLACK) {
    const auto write = [=](const fs::path& path, const Picture& picture) {
        TIFF* const tiff = TIFFOpen(path.c_str(), mode);
        ASSERT_NE(tiff, nullptr);
        TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, picture.columns);
        TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, picture.rows);
        TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
        TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, bits);
        TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, photometric);
        TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 5);
        auto bytes = scaled<std::uint8_t>(picture, 255, 1);
        auto words = scaled<std::uint16_t>(picture, 65535, 1);
        if (photometric == PHOTOMETRIC_MINISWHITE) {
            std::ranges::transform(bytes, bytes.begin(), std::bit_not<std::uint8_t>());
            std::ranges::transform(words, words.begin(), std::bit_not<std::uint16_t>());
        }
        for (int row = 0; row < picture.rows; ++row) {
            const auto first = static_cast<std::size_t>(row * picture.columns);
            void* const line = bits == 8 ? static_cast<void*>(&bytes[first]) : &words[first];
            EXPECT_EQ(TIFFWriteScanline(tiff, line, static_cast<std::uint32_t>(row)), 1);
        }
        TIFFClose(tiff);
    };
    return {.name = std::move(name), .write = write, .white = bits == 8 ? 255.0 : 65535.0};
}

std::string big_endian(std::uint32_t value, int bytes = 4) {
    std::string result;
    for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) {
        result += static_cast<char>(value >> shift & 0xff);
    }
    return result;
}

std::string bytes_of(const Picture& picture, const std::function<int(int)>& stored) {
    std::string bytes;
    for (const int value : picture.values) {
        bytes += static_cast<char>(stored(value));
    }
    return bytes;
}

// Writes a palette of greys in reverse, so that a pixel's number is not its grey value (PNG specification, colour type
// 3).
void write_palette_png(const fs::path& path, const Picture& picture) {
    const auto chunk = [](const std::string& typed) {
        const auto sum = crc32(0, reinterpret_cast<const Bytef*>(typed.data()), static_cast<uInt>(typed.size()));
        return big_endian(static_cast<std::uint32_t>(typed.size() - 4)) + typed +
               big_endian(static_cast<std::uint32_t>(sum));
    };
    const auto pixels = bytes_of(picture, [](int value) { return 255 - value; });
    std::string palette, rows;
    for (int entry = 0; entry < 256; ++entry) {
        palette += std::string(3, static_cast<char>(255 - entry));
    }
    for (int row = 0; row < picture.rows; ++row) {
        rows += '\0' + pixels.substr(static_cast<std::size_t>(row * picture.columns),
                                     static_cast<std::size_t>(picture.columns));
    }
    uLongf size = compressBound(static_cast<uLong>(rows.size()));
    std::string packed(size, '\0');
    ASSERT_EQ(compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(rows.data()),
                       static_cast<uLong>(rows.size())),
              Z_OK);
    packed.resize(size);
    write_file(path, "\x89PNG\r\n\x1a\n" +
                         chunk("IHDR" + big_endian(static_cast<std::uint32_t>(picture.columns)) +
                               big_endian(static_cast<std::uint32_t>(picture.rows)) + std::string("\x8\x3\0\0\0", 5)) +
                         chunk("PLTE" + palette) + chunk("IDAT" + packed) + chunk("IEND"));
}

// Writes two bytes a value, the first the higher (netpbm's "pgm"): the library writes one byte alone.
void write_pgm16(const fs::path& path, const Picture& picture) {
    std::string bytes = fmt::format("P5\n{} {}\n65535\n", picture.columns, picture.rows);
    for (const int value : picture.values) {
        bytes += big_endian(static_cast<std::uint32_t>(value * 257), 2);
    }
    write_file(path, bytes);
}

// Writes little-endian floats, the last row first (netpbm's "pfm"): the library writes bytes.
void write_pfm(const fs::path& path, const Picture& picture) {
    std::string bytes = fmt::format("Pf\n{} {}\n-1.0\n", picture.columns, picture.rows);
    for (int row = picture.rows - 1; row >= 0; --row) {
        for (int column = 0; column < picture.columns; ++column) {
            auto value = big_endian(std::bit_cast<std::uint32_t>(static_cast<float>(picture.at(column, row)) / 255));
            std::ranges::reverse(value);
            bytes += value;
        }
    }
    write_file(path, bytes);
}

// Writes a grey channel that is not packed (Adobe Photoshop file format: header, no palette, no resources, no layers,
// pixels).
void write_psd(const fs::path& path, const Picture& picture) {
    write_file(path, "8BPS" + big_endian(1, 2) + std::string(6, '\0') + big_endian(1, 2) +
                         big_endian(static_cast<std::uint32_t>(picture.rows)) +
                         big_endian(static_cast<std::uint32_t>(picture.columns)) + big_endian(8, 2) + big_endian(1, 2) +
                         std::string(12, '\0') + big_endian(0, 2) + bytes_of(picture, [](int value) { return value; }));
}

std::vector<Kind> formats() {
    using OIIO::TypeDesc;
    const TypeDesc word = TypeDesc::UINT16;
    // TIFFs are packed by codes that every library decodes to the bit.
    const auto tiff = [](const char* name, TypeDesc type, double white, const char* packing, int tile = 0) {
        return by_library(name, {.format = "tiff",
                                 .type = type,
                                 .white = white,
                                 .words = {{"compression", packing}},
                                 .numbers = {{tile > 0 ? "tile" : "tiff:RowsPerStrip", tile > 0 ? tile : 7}}});
    };
    std::vector<Kind> kinds = {
        tiff("plain.tif", TypeDesc::UINT8, 255, "none"),
        tiff("lzw.tif", TypeDesc::UINT8, 255, "lzw"),
        tiff("deflate16.tif", word, 65535, "zip"),
        tiff("packbits.tiff", TypeDesc::UINT8, 255, "packbits"),
        tiff("tiles.tif", TypeDesc::UINT8, 255, "none", 16),
        tiff("tiles16_lzw.tif", word, 65535, "lzw", 32),
        tiff("integers32.tif", TypeDesc::UINT32, 4294967295.0, "none"),
        tiff("floats.tif", TypeDesc::FLOAT, 1, "zip"),
        tiff("doubles.tif", TypeDesc::DOUBLE, 1, "none"),
        tiff("float_tiles.tif", TypeDesc::FLOAT, 1, "zip", 16),
        by_libtiff("big_endian.tif", "wb", 8),
        by_libtiff("big_endian16.tif", "wb", 16),
        by_libtiff("bigtiff16.tif", "wl8", 16),
        by_libtiff("bigtiff_big_endian.tif", "wb8", 8),
        by_libtiff("white_is_zero.tif", "wl", 8, PHOTOMETRIC_MINISWHITE),
        by_libtiff("white_is_zero_16.tif", "wl", 16, PHOTOMETRIC_MINISWHITE),
        by_library("grey8.png", {.format = "png"}),
        by_library("grey16.png", {.format = "png", .type = word, .white = 65535}),
        by_library("colour.png", {.format = "png", .channels = 3}),
        {.name = "palette.png", .write = write_palette_png},
        by_library("grey.bmp", {.format = "bmp"}),
        by_library("colour.bmp", {.format = "bmp", .channels = 3}),
        by_library("grey.pgm", {.format = "pnm"}),
        // The library rounds a value to the count below, now and then.
        {.name = "grey16.pgm", .write = write_pgm16, .white = 65535, .tolerance = 255.0 / 65535},
        by_library("text.pgm", {.format = "pnm", .numbers = {{"pnm:binary", 0}}}),
        by_library("colour.ppm", {.format = "pnm", .channels = 3}),
        by_library("grey.tga", {.format = "targa"}),
        by_library("packed.tga", {.format = "targa", .channels = 3, .words = {{"compression", "rle"}}}),
        by_library("grey.jp2", {.format = "jpeg2000"}),
        by_library("grey.j2k", {.format = "jpeg2000"}),
        // Quality 100 rounds each of 64 coefficients, which is two or three steps of a pixel at most.
        by_library("grey.jpg", {.format = "jpeg", .words = {{"compression", "jpeg:100"}}}, 3),
        by_library("colour.jpeg", {.format = "jpeg", .channels = 3, .words = {{"compression", "jpeg:100"}}}, 3),
        by_library("float.exr", {.format = "openexr", .type = TypeDesc::FLOAT, .white = 1}),
        // Half floats have 11 bits, HDR's mantissas 8.
        by_library("half.exr", {.format = "openexr", .type = TypeDesc::HALF, .white = 1}, 255.0 / 2048),
        by_library("colour.hdr", {.format = "hdr", .type = TypeDesc::FLOAT, .white = 1, .channels = 3}, 1),
        {.name = "floats.pfm", .write = write_pfm, .white = 1},
    };
    // The library's encoder passes through luminance and colour at half the resolution, also where it is to lose
    // nothing.
    kinds.push_back(
        by_library("colour.webp", {.format = "webp", .channels = 3, .words = {{"compression", "lossless:100"}}}, 4));
    kinds.back().grey = false;
    for (int orientation = 1; orientation <= 8; ++orientation) {
        for (const auto& [format, ending, tolerance] :
             {std::tuple("jpeg", "jpg", 3.0), std::tuple("tiff", "tif", 0.0)}) {
            ByLibrary how{.format = format, .numbers = {{"Orientation", orientation}}};
            how.words["compression"] = tolerance > 0 ? "jpeg:100" : "lzw";
            kinds.push_back(
                {.name = fmt::format("turned_{}.{}", orientation, ending),
                 .write = [=](const fs::path& path,
                              const Picture& picture) { write_by_library(path, stored_as(picture, orientation), how); },
                 .tolerance = tolerance});
        }
    }
    return kinds;
}

// Formats that are read from a file of their own alone: in a folder they are seldom an image of the stack.
std::vector<Kind> formats_of_single_files() {
    std::vector<Kind> kinds = {by_library("grey.dpx", {.format = "dpx"}), {.name = "grey.psd", .write = write_psd}};
    // The library's encoder has few colours for a picture.
    kinds.push_back(by_library("colour.gif", {.format = "gif", .channels = 3}, 16));
    kinds.back().grey = false;
    return kinds;
}

// --- Routes

template <class Value>
void expect_picture(const Grid<Value>& read, const Picture& picture, double white, double tolerance,
                    const std::string& what) {
    ASSERT_EQ(read.columns, picture.columns) << what;
    ASSERT_EQ(read.rows, picture.rows) << what;
    double worst = 0;
    for (int row = 0; row < picture.rows; ++row) {
        for (int column = 0; column < picture.columns; ++column) {
            const double value = static_cast<double>(read(column, picture.rows - 1 - row)) * 255 / white;
            worst = std::max(worst, std::abs(value - picture.at(column, row)));
        }
    }
    EXPECT_LE(worst, tolerance + 255e-6) << what; // rounding of floats, which hold 24 bits
}

void expect_channels(const std::vector<Grid<float>>& channels, const Kind& kind, const Picture& picture,
                     const std::string& what) {
    EXPECT_TRUE(channels.size() == 1 || channels.size() == 3) << what;
    for (const auto& channel : channels) {
        expect_picture(channel, picture, kind.white, kind.tolerance, what);
    }
}

void expect_by_every_route(const fs::path& file, const Kind& kind, const Picture& picture) {
    const std::string what = file.string();
    // The routes are a file of pages, a point spread, heights and a pattern.
    const scan::ImageSeries pages(file);
    EXPECT_EQ(pages.size(), 1) << what;
    expect_channels(pages.read(0), kind, picture, what);
    if (kind.grey) {
        expect_picture(images::read_image(file), picture, kind.white, kind.tolerance, what);
        // Integers come as shares of white.
        expect_picture(specimen::read_image(file, {}), picture, 1, kind.tolerance, what);
        const specimen::Reflectance printed{
            .kind = specimen::Reflectance::Kind::image, .lowest = 0, .highest = 1, .pitch = 1, .file = file};
        expect_picture(specimen::make_reflectance_map(printed, {}, {}).values, picture, 1, kind.tolerance, what);
    }
    const surface::ImageScale scale{.pitch = 0.001, .unit = 0.001};
    if (file.extension() == ".tif" || file.extension() == ".tiff" || file.extension() == ".exr") {
        // Heights come in mm.
        expect_picture(surface::read_surface(file, scale).map.height, picture, 0.001 * kind.white, kind.tolerance,
                       what);
    } else {
        EXPECT_THROW((void)surface::read_surface(file, scale), InputError) << what;
    }
}

constexpr std::uintmax_t stream_block = 4096;

TEST(ImageFormats, EveryFormatByEveryRouteIsThePictureThatWasWritten) {
    const Picture large = noisy(120, 80);
    for (const auto& kind : formats()) {
        // The encoder of JPEG 2000 halves a picture five times, and writes broken files of smaller ones.
        const bool halved = kind.name.ends_with(".jp2") || kind.name.ends_with(".j2k");
        const Picture small = halved ? smooth(34, 33) : smooth(11, 7);
        for (const Picture* picture : {&small, &large}) {
            // A folder of one image is a series of files.
            const auto folder = fresh_folder("format");
            const auto file = folder / kind.name;
            kind.write(file, *picture);
            EXPECT_EQ(fs::file_size(file) > stream_block, picture == &large) << file;
            expect_channels(scan::ImageSeries(folder).read(0), kind, *picture, folder.string() + " with " + kind.name);
            expect_by_every_route(file, kind, *picture);
        }
    }
    const Picture small = smooth(11, 7);
    for (const auto& kind : formats_of_single_files()) {
        for (const Picture* picture : {&small, &large}) {
            const auto file = fresh_folder("format") / kind.name;
            kind.write(file, *picture);
            expect_by_every_route(file, kind, *picture);
        }
    }
}

// The wrong twin of the orientations: taken as stored, seven of the eight are another picture.
TEST(ImageFormats, AnOrientationChangesThePicture) {
    const Picture picture = smooth(11, 7);
    for (int orientation = 1; orientation <= 8; ++orientation) {
        const Picture stored = stored_as(picture, orientation);
        EXPECT_EQ(stored.columns == picture.columns && stored.values == picture.values, orientation == 1);
    }
    const Picture turned = stored_as(picture, 6); // a camera on its side: the stored first row is the right side
    EXPECT_EQ(turned.at(0, 0), picture.at(picture.columns - 1, 0));
    EXPECT_EQ(turned.at(turned.columns - 1, 0), picture.at(picture.columns - 1, picture.rows - 1));
}

TEST(ImageFormats, AnEndingDoesNotHideWhatAFileIs) {
    const Picture picture = noisy(90, 61);
    const auto folder = fresh_folder("endings");
    const Kind jpeg = by_library("a.jpg", {.format = "jpeg", .words = {{"compression", "jpeg:100"}}}, 3);
    jpeg.write(folder / jpeg.name, picture);
    for (const char* name : {"b.tif", "c.png", "d.bmp", "e.JPG"}) {
        fs::copy_file(folder / jpeg.name, folder / name);
        expect_channels(images::read_channels(folder / name), jpeg, picture, name);
        expect_picture(specimen::read_image(folder / name, {}), picture, 1, jpeg.tolerance, name);
    }
}

// Colours stay apart, in the file's order; specimens refuse them.
TEST(ImageFormats, ColoursAreChannels) {
    const auto folder = fresh_folder("colours");
    const int columns = 64, rows = 48;
    std::vector<std::uint8_t> values;
    for (int k = 0; k < columns * rows; ++k) {
        for (const int value : {40 + k % columns, 200 - k % columns, 90 + k / columns}) {
            values.push_back(static_cast<std::uint8_t>(value));
        }
    }
    // JPEG stores luminance and two differences, to about a step each, of which a colour takes up to 1.8.
    for (const auto& [format, name, tolerance] :
         {std::tuple("jpeg", "a.jpg", 5), std::tuple("png", "a.png", 0), std::tuple("tiff", "a.tif", 0),
          std::tuple("bmp", "a.bmp", 0), std::tuple("pnm", "a.ppm", 0), std::tuple("targa", "a.tga", 0),
          std::tuple("jpeg2000", "a.jp2", 0)}) {
        const auto output = OIIO::ImageOutput::create(format);
        OIIO::ImageSpec spec(columns, rows, 3, OIIO::TypeDesc::UINT8);
        if (tolerance > 0) {
            spec.attribute("compression", "jpeg:100");
            spec.attribute("jpeg:subsampling", "4:4:4");
        }
        ASSERT_TRUE(output->open((folder / name).string(), spec)) << output->geterror();
        ASSERT_TRUE(output->write_image(OIIO::TypeDesc::UINT8, values.data()) && output->close());
        const auto channels = images::read_channels(folder / name);
        ASSERT_EQ(channels.size(), 3u) << name;
        for (std::size_t k = 0; k < values.size(); ++k) {
            const int pixel = static_cast<int>(k / 3);
            ASSERT_NEAR(channels[k % 3](pixel % columns, rows - 1 - pixel / columns), values[k], tolerance) << name;
        }
        EXPECT_THROW((void)specimen::read_image(folder / name, {}), InputError) << name;
        EXPECT_THROW((void)images::read_image(folder / name), InputError) << name;
    }
}

// Cyan, magenta, yellow and black of printers become red, green and blue: (1 - c)(1 - k) and so on.
TEST(ImageFormats, InksBecomeColours) {
    const auto file = fresh_folder("inks") / "inks.tif";
    constexpr int side = 40;
    const auto ink = [](int column, int row, int channel) { return (5 * column + 3 * row + 40 * channel) % 200; };
    TIFF* const tiff = TIFFOpen(file.c_str(), "wl");
    ASSERT_NE(tiff, nullptr);
    for (const auto& [tag, value] : {std::pair(TIFFTAG_IMAGEWIDTH, side), std::pair(TIFFTAG_IMAGELENGTH, side),
                                     std::pair(TIFFTAG_SAMPLESPERPIXEL, 4), std::pair(TIFFTAG_BITSPERSAMPLE, 8),
                                     std::pair(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_SEPARATED),
                                     std::pair(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG)}) {
        TIFFSetField(tiff, static_cast<std::uint32_t>(tag), value);
    }
    for (int row = 0; row < side; ++row) {
        std::vector<std::uint8_t> line;
        for (int k = 0; k < 4 * side; ++k) {
            line.push_back(static_cast<std::uint8_t>(ink(k / 4, row, k % 4)));
        }
        EXPECT_EQ(TIFFWriteScanline(tiff, line.data(), static_cast<std::uint32_t>(row)), 1);
    }
    TIFFClose(tiff);
    const auto channels = images::read_channels(file);
    ASSERT_EQ(channels.size(), 3u);
    for (int channel = 0; channel < 3; ++channel) {
        for (const auto& [column, row] : {std::pair(0, 0), std::pair(7, 30), std::pair(39, 12)}) {
            const double expected = (255 - ink(column, row, channel)) * (255 - ink(column, row, 3)) / 255.0;
            EXPECT_NEAR(channels[static_cast<std::size_t>(channel)](column, side - 1 - row), expected, 1);
        }
    }
}

// Pages of one file, each larger than a block of C's streams, are read in any order and by several threads.
TEST(ImageFormats, PagesAreReadInAnyOrderAndAtOnce) {
    const auto file = fresh_folder("pages") / "pages.tif";
    constexpr int count = 6;
    std::vector<Picture> pictures(count, noisy(90, 61));
    const auto output = OIIO::ImageOutput::create("tiff");
    std::vector<OIIO::ImageSpec> specs(count, OIIO::ImageSpec(90, 61, 1, OIIO::TypeDesc::UINT8));
    for (int page = 0; page < count; ++page) {
        Picture& picture = pictures[static_cast<std::size_t>(page)];
        std::ranges::rotate(picture.values, picture.values.begin() + 100 * page);
        ASSERT_TRUE(page == 0 ? output->open(file.string(), count, specs.data())
                              : output->open(file.string(), specs[0], OIIO::ImageOutput::AppendSubimage));
        const auto values = scaled<std::uint8_t>(picture, 255, 1);
        ASSERT_TRUE(output->write_image(OIIO::TypeDesc::UINT8, values.data()));
    }
    ASSERT_TRUE(output->close());
    const scan::ImageSeries series(file);
    ASSERT_EQ(series.size(), count);
    std::atomic<int> right = 0;
    std::vector<std::thread> threads;
    for (int start = 0; start < 3; ++start) {
        threads.emplace_back([&, start] {
            for (int k = 0; k < count; ++k) {
                const int page = (start + 5 * k) % count;
                const Picture& picture = pictures[static_cast<std::size_t>(page)];
                const auto channels = series.read(page);
                bool same = channels.size() == 1;
                for (int row = 0; same && row < picture.rows; ++row) {
                    for (int column = 0; column < picture.columns; ++column) {
                        same = same && channels[0](column, picture.rows - 1 - row) ==
                                           static_cast<float>(picture.at(column, row));
                    }
                }
                right += same ? 1 : 0;
            }
        });
    }
    for (auto& thread : threads) {
        thread.join();
    }
    EXPECT_EQ(right, 3 * count);
}

TEST(ImageFormats, WhatIsNotReadSaysWhatIs) {
    const auto folder = fresh_folder("unread");
    const auto told = [](const std::function<void()>& read) -> std::string {
        try {
            read();
        } catch (const InputError& error) {
            return error.what();
        }
        return "nothing was refused";
    };
    const Picture picture = smooth(11, 7);
    // A raw file begins like the TIFF that its thumbnail is.
    for (const char* name : {"IMG_1.NEF", "IMG_1.cr2", "IMG_1.dng"}) {
        write_by_library(folder / "thumbnail.tif", picture, {.format = "tiff"});
        fs::rename(folder / "thumbnail.tif", folder / name);
        EXPECT_THAT(told([&] { (void)scan::ImageSeries(folder / name); }), HasSubstr("raw file")) << name;
        EXPECT_THAT(told([&] { (void)images::read_channels(folder / name); }), HasSubstr("Develop")) << name;
    }
    EXPECT_THAT(told([&] { (void)scan::ImageSeries(folder); }), HasSubstr("raw files"));
    write_file(folder / "photograph.heic", std::string("\0\0\0\x18"
                                                       "ftypheic",
                                                       12) +
                                               std::string(5000, '\0'));
    write_file(folder / "empty.jpg", "");
    write_file(folder / "cut.jpg", "\xff\xd8\xff\xe0");
    for (const char* name : {"photograph.heic", "empty.jpg"}) {
        EXPECT_THAT(told([&] { (void)images::read_channels(folder / name); }), HasSubstr("unknown kind")) << name;
        EXPECT_THAT(told([&] { (void)specimen::read_image(folder / name, {}); }), HasSubstr("JPEG 2000")) << name;
    }
    EXPECT_THROW((void)images::read_channels(folder / "cut.jpg"), InputError);
    // OpenImageIO 2.4 returns what was in the memory before.
    write_by_library(folder / "tiles.tif", smooth(40, 30),
                     {.format = "tiff", .type = OIIO::TypeDesc::DOUBLE, .white = 1, .numbers = {{"tile", 16}}});
    EXPECT_THAT(told([&] { (void)images::read_channels(folder / "tiles.tif"); }), HasSubstr("64 bits"));
    EXPECT_THAT(told([&] { (void)specimen::read_image(folder / "tiles.tif", {}); }), HasSubstr("64 bits"));
    EXPECT_THAT(told([&] { (void)surface::read_surface(folder / "tiles.tif", {.pitch = 1, .unit = 1}); }),
                HasSubstr("64 bits"));
}

// --- By the program

// The heights of a stack of JPEGs, as photographs are, are those of the same images as PNG.
TEST(ImageFormats, AStackOfJpegsHasTheHeightsOfTheSameImages) {
    const auto folder = fresh_folder("photographs");
    constexpr int side = 80, images = 9;
    std::mt19937 random(3);
    std::vector<double> texture(side * side);
    std::ranges::generate(texture, [&] { return static_cast<double>(random() % 1000) / 1000 - 0.5; });
    fs::create_directory(folder / "jpeg");
    fs::create_directory(folder / "png");
    for (int k = 0; k < images; ++k) {
        Picture picture{.columns = side, .rows = side};
        for (int p = 0; p < side * side; ++p) {
            const double sharp = std::exp(-std::pow(k - 2 - 4.0 * (p % side) / side, 2) / 4); // a slope along x
            picture.values.push_back(
                static_cast<int>(std::lround(128 + 200 * texture[static_cast<std::size_t>(p)] * sharp)));
        }
        const auto file = folder / fmt::format("jpeg/i{}.jpg", k);
        write_by_library(file, picture, {.format = "jpeg", .words = {{"compression", "jpeg:90"}}});
        EXPECT_GT(fs::file_size(file) + 2000 * static_cast<unsigned>(std::abs(k - 4)), stream_block);
        // The pixels that the image library reads from the file by its name, without vkfv, are the truth.
        const auto input = OIIO::ImageInput::open(file.string());
        ASSERT_TRUE(input) << OIIO::geterror();
        std::vector<std::uint8_t> decoded(side * side);
        ASSERT_TRUE(input->read_image(0, 0, 0, 1, OIIO::TypeDesc::UINT8, decoded.data()));
        picture.values.assign(decoded.begin(), decoded.end());
        write_by_library(folder / fmt::format("png/i{}.png", k), picture, {.format = "png"});
    }
    for (const char* name : {"jpeg", "png"}) {
        const auto result = run_program({"topography", name, "--z_step_um", "2", "--pitch_um", "1", "--out",
                                         std::string("of_") + name, "--set", "topography.window_px=5"},
                                        folder);
        ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    }
    EXPECT_EQ(read_file(folder / "of_jpeg/topography.tif"), read_file(folder / "of_png/topography.tif"));
    const auto results = nlohmann::json::parse(read_file(folder / "of_jpeg/results.json"));
    EXPECT_GT(results["measured_share"], 0.9);
}

// Height maps that another program packed anew compare as the one that vkfv wrote.
TEST(ImageFormats, APackedHeightMapComparesAsTheSame) {
    const auto folder = fresh_folder("packed");
    surface::HeightMap map{.height = Grid<double>(70, 50), .pitch_x = 0.001, .pitch_y = 0.001};
    for (int row = 0; row < map.rows(); ++row) {
        for (int column = 0; column < map.columns(); ++column) {
            map.height(column, row) = 1e-3 * std::sin(0.3 * column) + 2e-4 * std::cos(0.5 * row);
        }
    }
    surface::write_height_map(folder / "map.tif", map);
    const auto input = OIIO::ImageInput::open((folder / "map.tif").string());
    ASSERT_TRUE(input) << OIIO::geterror();
    std::vector<float> values(70 * 50);
    ASSERT_TRUE(input->read_image(0, 0, 0, 1, OIIO::TypeDesc::FLOAT, values.data()));
    OIIO::ImageSpec spec = input->spec();
    spec.tile_width = spec.tile_height = 16;
    spec.tile_depth = 1;
    spec.attribute("compression", "zip");
    const auto output = OIIO::ImageOutput::create("tiff");
    ASSERT_TRUE(output->open((folder / "packed.tif").string(), spec)) << output->geterror();
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, values.data()) && output->close());
    EXPECT_GT(fs::file_size(folder / "packed.tif"), stream_block);
    const auto result = run_program({"compare", "packed.tif", "map.tif", "--json"}, folder);
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    EXPECT_EQ(nlohmann::json::parse(result.standard_output)["rms_deviation_um"], 0);
    const auto packed = surface::read_height_map(folder / "packed.tif"),
               plain = surface::read_height_map(folder / "map.tif");
    EXPECT_EQ(packed.height.values, plain.height.values);
    EXPECT_EQ(packed.pitch_x, plain.pitch_x);
}

} // namespace
} // namespace vkfv::test
