// Height maps as OpenEXR are read from whole files of every layout; damaged and lying ones are refused.
#include "surface_files/height_image.hpp"

#include "core/messages/error.hpp"
#include "surface/exr_bytes.hpp"

#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vkfv::surface {
namespace {

using test::ExrBytes;

constexpr ImageScale scale = {.pitch = 0.002, .unit = 1e-3};

std::vector<double> heights_of(const std::string& bytes) {
    return parse_height_image(bytes, "a.exr", scale).map.height.values;
}

TEST(HeightImage, ExrIsReadWithItsScale) {
    ExrBytes exr;
    exr.values[1] = std::numeric_limits<float>::infinity();
    const SurfaceFile file = parse_height_image(exr.bytes(), "a.exr", scale);
    ASSERT_EQ(file.map.columns(), 3);
    ASSERT_EQ(file.map.rows(), 2);
    EXPECT_EQ(file.map.pitch_x, 0.002);
    EXPECT_EQ(file.map.pitch_y, 0.002);
    EXPECT_EQ(file.map.x0, 0);
    EXPECT_EQ(file.map.y0, 0);
    // The first row of the file has the highest y; small integers in float32 are exact.
    EXPECT_THAT(file.map.height.values,
                testing::ElementsAre(testing::DoubleEq(4e-3), testing::DoubleEq(5e-3), testing::DoubleEq(6e-3),
                                     testing::DoubleEq(1e-3), testing::IsNan(), testing::DoubleEq(3e-3)));
    EXPECT_THROW((void)parse_height_image(exr.bytes(), "a.exr", {}), InputError);
    EXPECT_THROW((void)parse_height_image(exr.bytes(), "a.exr", {.pitch = 0.002, .unit = {}}), InputError);
    EXPECT_THROW((void)parse_height_image(exr.bytes(), "a.exr", {.pitch = {}, .unit = 1e-3}), InputError);
}

TEST(HeightImage, ExrOfEveryLayoutHasTheSameHeights) {
    const std::vector<double> expected = heights_of(ExrBytes{}.bytes());
    for (const std::uint32_t tile : {0, 1, 2, 16})
        for (const int parts : {1, 2, 3})
            EXPECT_EQ(heights_of(ExrBytes{.tile = tile, .parts = parts}.bytes()), expected) << tile << " " << parts;
    EXPECT_EQ(heights_of(ExrBytes{.window = {-7, 5, -5, 6}}.bytes()), expected); // a window that starts elsewhere
    ExrBytes other;
    other.values[0] = 9; // the wrong twin
    EXPECT_NE(heights_of(other.bytes()), expected);
}

void expect_refused(const std::string& bytes, const std::string& what) {
    try {
        (void)parse_height_image(bytes, "bad.exr", scale);
        ADD_FAILURE() << what << " was accepted";
    } catch (const InputError& error) {
        EXPECT_EQ(error.problem().where.file, "bad.exr");
        EXPECT_FALSE(error.problem().remedy.empty());
    }
}

TEST(HeightImage, TruncatedExrIsRefused) {
    for (const std::uint32_t tile : {0, 2})
        for (const int parts : {1, 2}) {
            const std::string whole = ExrBytes{.tile = tile, .parts = parts}.bytes();
            EXPECT_NO_THROW((void)heights_of(whole));
            // The last part's pixels are the end of the file: 24 bytes, with number, coordinates and size of two rows
            // or tiles. If there is one part, no byte may be missing; a second part is not read.
            const std::size_t needed = whole.size() - (parts == 1 ? 0 : 24 + 2 * (tile == 0 ? 12 : 24));
            for (std::size_t length = 0; length < needed; ++length)
                expect_refused(whole.substr(0, length), fmt::format("{} of {} bytes", length, whole.size()));
        }
}

TEST(HeightImage, ExrWhoseHeaderLiesIsRefused) {
    constexpr std::int32_t largest = std::numeric_limits<std::int32_t>::max(), half = (1 << 30) - 2;
    const std::vector<std::vector<std::int32_t>> windows = {
        {0, 0, 1 << 20, 1}, {0, 0, 2, 1 << 20}, {0, 0, 65535, 65535},     {0, 0, half, 1}, {0, 0, 2, half},
        {0, 0, half, half}, {0, 0, largest, 1}, {0, 0, largest, largest}, {2, 1, 0, 0},    {-largest, 0, largest, 1}};
    for (const int parts : {1, 2})
        for (const std::uint32_t tile : {0u, 2u, 1u << 15, 1u << 20, 0x7fffffffu}) {
            for (const auto& window : windows)
                expect_refused(ExrBytes{.window = window, .tile = tile, .parts = parts}.bytes(),
                               fmt::format("window {}, tile {}, {} parts", fmt::join(window, " "), tile, parts));
        }
    for (const std::uint32_t tile : {0x80000000u, 0xffffffffu})
        expect_refused(ExrBytes{.tile = tile}.bytes(), fmt::format("tile {}", tile));
}

// The library makes room for every tile as a whole: twice 1 GB for six pixels were found by fuzzing.
TEST(HeightImage, ExrOfSmallImageAndVastTilesIsRefused) {
    std::string bytes = ExrBytes{.tile = 2}.bytes();
    constexpr std::string_view before("tiledesc\0", 9);
    constexpr std::int32_t height = 0x7b20002;
    const std::size_t place = bytes.find(before) + before.size() + 4; // behind the length
    std::memcpy(bytes.data() + place + 4, &height, sizeof height);
    try {
        (void)parse_height_image(bytes, "bad.exr", scale);
        ADD_FAILURE() << "accepted";
    } catch (const InputError& error) {
        EXPECT_EQ(error.problem().where.byte_offset, place);
    }
}

// The library would make room for the text before it looks for it; 1.7 GB of it were found by fuzzing.
TEST(HeightImage, ExrWithAnAttributeLongerThanTheFileIsRefusedAtItsLength) {
    for (const int parts : {1, 2})
        for (const std::int32_t length : {-1, 500, 0x68680000, std::numeric_limits<std::int32_t>::max()}) {
            std::string bytes = ExrBytes{.parts = parts}.bytes();
            constexpr std::string_view before("compression\0compression\0", 24);
            const std::size_t place = bytes.rfind(before) + before.size();
            std::memcpy(bytes.data() + place, &length, sizeof length);
            try {
                (void)parse_height_image(bytes, "bad.exr", scale);
                ADD_FAILURE() << length << " was accepted";
            } catch (const InputError& error) {
                EXPECT_EQ(error.problem().where.byte_offset, place);
            }
        }
}

} // namespace
} // namespace vkfv::surface
