#include "images/image_file.hpp"
#include "support/surface_files.hpp"

#include "core/messages/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace vkfv::surface {
using namespace images;
namespace {

class ImageFile : public testing::Test {
  protected:
    ImageFile()
        : folder_(std::filesystem::path(testing::TempDir()) /
                  ("vkfv_image_file_" + std::to_string(::getpid()) + "_" +
                   testing::UnitTest::GetInstance()->current_test_info()->name())) {
        std::filesystem::create_directories(folder_);
    }
    ~ImageFile() override { std::filesystem::remove_all(folder_); }
    std::filesystem::path file(const std::string& name) const { return folder_ / name; }

    std::filesystem::path folder_;
};

// The letter F as seen from +z, first line at the top (highest y).
const std::vector<std::string> letter = {"######", "#.....", "####..", "#.....", "#.....", "#....."};

template <class Value>
Grid<Value> letter_grid(Value ink, Value paper) {
    const int rows = static_cast<int>(letter.size()), columns = static_cast<int>(letter[0].size());
    Grid<Value> grid(columns, rows);
    for (int line = 0; line < rows; ++line)
        for (int column = 0; column < columns; ++column)
            grid(column, rows - 1 - line) =
                letter[static_cast<std::size_t>(line)][static_cast<std::size_t>(column)] == '#' ? ink : paper;
    return grid;
}

std::vector<char> bytes_of(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

// An uncompressed little-endian TIFF read from its bytes by the TIFF 6.0 specification, without OpenImageIO.
struct RawTiff {
    std::vector<char> bytes;
    struct Entry {
        std::uint16_t type;
        std::uint32_t count;
        std::size_t at; // of the values
    };
    std::map<int, Entry> entries;

    template <class Value>
    Value get(std::size_t at) const {
        Value value;
        EXPECT_LE(at + sizeof value, bytes.size());
        std::memcpy(&value, bytes.data() + at, sizeof value);
        return value;
    }
    explicit RawTiff(const std::filesystem::path& path) : bytes(bytes_of(path)) {
        EXPECT_EQ(std::string(bytes.data(), 2), "II");
        EXPECT_EQ(get<std::uint16_t>(2), 42);
        const std::size_t directory = get<std::uint32_t>(4);
        for (std::size_t k = 0; k < get<std::uint16_t>(directory); ++k) {
            const std::size_t at = directory + 2 + 12 * k;
            const auto type = get<std::uint16_t>(at + 2);
            const auto count = get<std::uint32_t>(at + 4);
            const std::map<int, std::size_t> size = {{1, 1}, {2, 1}, {3, 2}, {4, 4}, {5, 8}, {7, 1}};
            const std::size_t length = count * (size.contains(type) ? size.at(type) : 8);
            entries[get<std::uint16_t>(at)] = {type, count,
                                               length <= 4 ? at + 8 : std::size_t{get<std::uint32_t>(at + 8)}};
        }
    }
    std::uint32_t number(int tag, std::size_t index = 0) const {
        const Entry& entry = entries.at(tag);
        return entry.type == 3 ? get<std::uint16_t>(entry.at + 2 * index) : get<std::uint32_t>(entry.at + 4 * index);
    }
    double rational(int tag) const {
        const std::size_t at = entries.at(tag).at;
        return static_cast<double>(get<std::uint32_t>(at)) / get<std::uint32_t>(at + 4);
    }
    std::string text(int tag) const {
        const Entry& entry = entries.at(tag);
        return {bytes.data() + entry.at, entry.count - 1};
    }
    // Pixel values in the file's order, first row first.
    template <class Value>
    std::vector<Value> pixels() const {
        EXPECT_EQ(number(259), 1u) << "compression";
        EXPECT_EQ(number(258), 8 * sizeof(Value)) << "bits per pixel";
        std::vector<Value> result;
        for (std::size_t strip = 0; strip < entries.at(273).count; ++strip)
            for (std::size_t k = 0; k < number(279, strip) / sizeof(Value); ++k)
                result.push_back(get<Value>(number(273, strip) + k * sizeof(Value)));
        return result;
    }
};

TEST_F(ImageFile, LetterIsUprightInTheBytesOfFloatImages) {
    write_tiff(file("letter.tif"), letter_grid(2.5f, 0.5f));
    const RawTiff tiff(file("letter.tif"));
    ASSERT_EQ(tiff.number(256), letter[0].size());
    ASSERT_EQ(tiff.number(257), letter.size());
    EXPECT_EQ(tiff.number(339), 3u) << "sample format: IEEE float";
    if (tiff.entries.contains(274)) {
        EXPECT_EQ(tiff.number(274), 1u) << "orientation: first row on top, first column left";
    }
    std::string seen, expected;
    for (const float value : tiff.pixels<float>())
        seen += value == 2.5f ? '#' : value == 0.5f ? '.' : '?';
    for (const std::string& line : letter)
        expected += line;
    EXPECT_EQ(seen, expected);
    // The wrong twin is an image whose rows were not flipped.
    std::string upside_down;
    for (auto line = letter.rbegin(); line != letter.rend(); ++line)
        upside_down += *line;
    EXPECT_NE(seen, upside_down);
}

TEST_F(ImageFile, LetterIsUprightInTheBytesOfIntegerImages) {
    write_tiff(file("letter.tif"), letter_grid<std::uint16_t>(65535, 7));
    std::string seen, expected;
    for (const std::uint16_t value : RawTiff(file("letter.tif")).pixels<std::uint16_t>())
        seen += value == 65535 ? '#' : value == 7 ? '.' : '?';
    for (const std::string& line : letter)
        expected += line;
    EXPECT_EQ(seen, expected);
}

TEST_F(ImageFile, IsOneStripForGwyddion) {
    write_tiff(file("tall.tif"), Grid<float>(3, 700, 1.0f));
    EXPECT_EQ(RawTiff(file("tall.tif")).entries.at(273).count, 1u);
}

TEST_F(ImageFile, ReaderReturnsWhatWasWritten) {
    const auto floats = letter_grid(1.25f, -3e-12f);
    const auto counts = letter_grid<std::uint16_t>(40000, 3);
    write_tiff(file("floats.tif"), floats);
    write_tiff(file("counts.tif"), counts);
    EXPECT_EQ(page_count(file("floats.tif")), 1);
    EXPECT_EQ(read_image(file("floats.tif")).values, floats.values);
    const Grid<float> read = read_image(file("counts.tif"));
    EXPECT_EQ(std::vector<std::uint16_t>(read.values.begin(), read.values.end()), counts.values);
}

TEST_F(ImageFile, PitchBecomesPixelsPerCentimetre) {
    write_tiff(file("pitch.tif"), letter_grid(1.0f, 0.0f), {.pitch_x = 0.002, .pitch_y = 0.004, .description = "d"});
    const RawTiff tiff(file("pitch.tif"));
    EXPECT_EQ(tiff.number(296), 3u) << "resolution unit: centimetre";
    // The resolution is 10 mm / pitch; the library's rationals hold float32.
    EXPECT_NEAR(tiff.rational(282), 5000, 5000 * 1e-6);
    EXPECT_NEAR(tiff.rational(283), 2500, 2500 * 1e-6);
    EXPECT_EQ(tiff.text(270), "d");
}

TEST_F(ImageFile, TwoWritesAreByteIdenticalAndLeaveNothingAside) {
    write_tiff(file("a.tif"), letter_grid(1.0f, 0.0f), {.pitch_x = 0.002, .pitch_y = 0.002, .description = "text"});
    ::sleep(1); // a clock in the file would show: TIFF's DateTime has whole seconds
    write_tiff(file("b.tif"), letter_grid(1.0f, 0.0f), {.pitch_x = 0.002, .pitch_y = 0.002, .description = "text"});
    EXPECT_EQ(bytes_of(file("a.tif")), bytes_of(file("b.tif")));
    int files = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder_))
        ++files;
    EXPECT_EQ(files, 2);
}

TEST_F(ImageFile, HeightMapKeepsGridAndNotMeasuredPoints) {
    HeightMap map;
    map.height = letter_grid(1.5e-3, -2.25e-3);
    map.height(1, 2) = std::numeric_limits<double>::quiet_NaN();
    map.x0 = -0.0631;
    map.y0 = 1.0 / 3;
    map.pitch_x = 0.0019999;
    map.pitch_y = 0.0021;
    write_height_map(file("map.tif"), map);
    const HeightMap read = read_height_map(file("map.tif"));
    EXPECT_EQ(read.x0, map.x0);
    EXPECT_EQ(read.y0, map.y0);
    EXPECT_EQ(read.pitch_x, map.pitch_x);
    EXPECT_EQ(read.pitch_y, map.pitch_y);
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column) {
            if (column == 1 && row == 2)
                EXPECT_TRUE(std::isnan(read.height(column, row)));
            else // half a float32 step, 2^-24, and two roundings in double
                EXPECT_NEAR(read.height(column, row), map.height(column, row), 6e-8 * 2.25e-3);
        }
    // The file holds micrometres, and its last row is row 0.
    const auto pixels = RawTiff(file("map.tif")).pixels<float>();
    EXPECT_FLOAT_EQ(pixels.front(), 1.5f);
    EXPECT_FLOAT_EQ(pixels.back(), -2.25f);
}

void expect_input_error(const std::filesystem::path& path, void (*read)(const std::filesystem::path&)) {
    try {
        read(path);
        ADD_FAILURE() << path << " was accepted";
    } catch (const InputError& error) {
        EXPECT_EQ(error.problem().where.file, path);
        EXPECT_FALSE(error.problem().remedy.empty());
    }
}

TEST_F(ImageFile, BadFilesAreInputErrors) {
    const auto image = [](const std::filesystem::path& path) { read_image(path); };
    const auto map = [](const std::filesystem::path& path) { read_height_map(path); };
    expect_input_error(file("missing.tif"), image);
    std::ofstream(file("text.tif")) << "not an image at all";
    expect_input_error(file("text.tif"), image);
    std::ofstream(file("empty.tif"));
    expect_input_error(file("empty.tif"), image);

    Grid<float> large(64, 64, 1.0f);
    write_tiff(file("whole.tif"), large);
    expect_input_error(file("whole.tif"), map); // says nothing of its grid
    expect_input_error(file("whole.tif"), [](const std::filesystem::path& path) { read_image(path, 1); });
    // libtiff may put the directory before or after the pixels: cut in the middle, either way data are
    // missing.
    std::filesystem::copy_file(file("whole.tif"), file("cut.tif"));
    std::filesystem::resize_file(file("cut.tif"), std::filesystem::file_size(file("whole.tif")) / 2);
    expect_input_error(file("cut.tif"), image);
}

TEST_F(ImageFile, UnwritableFolderIsARunError) {
    EXPECT_THROW(write_tiff(file("no_such_folder") / "a.tif", letter_grid(1.0f, 0.0f)), RunError);
}

TEST_F(ImageFile, ChannelsComeBackOneByOne) {
    const auto path = std::filesystem::path(testing::TempDir()) / "channels.tif";
    std::vector<Grid<float>> channels(3, Grid<float>(4, 3));
    for (std::size_t channel = 0; channel < 3; ++channel)
        for (std::size_t k = 0; k < 12; ++k)
            channels[channel].values[k] = static_cast<float>(100 * channel + k);
    write_tiff(path, channels);
    const auto read = read_channels(path);
    ASSERT_EQ(read.size(), 3u);
    for (std::size_t channel = 0; channel < 3; ++channel)
        EXPECT_EQ(read[channel].values, channels[channel].values);
    EXPECT_THROW(read_image(path), InputError); // read_image() takes images with one channel
    write_tiff(path, channels[1]);
    EXPECT_EQ(read_channels(path).size(), 1u);
}

} // namespace
} // namespace vkfv::surface
