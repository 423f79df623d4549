// The images that a page has of a stack are means of blocks, few enough, in 8 bits.
#include "report/frames.hpp"

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>

namespace vkfv::report {
namespace {

using testing::ElementsAre;

// The grey values of a PNG, as another library reads them; the first row on top.
std::vector<std::uint8_t> pixels_of(const std::string& png, int columns, int rows) {
    const std::string file = testing::TempDir() + "frame.png";
    std::ofstream(file, std::ios::binary) << png;
    const auto input = OIIO::ImageInput::open(file);
    EXPECT_TRUE(input);
    EXPECT_EQ(input->spec().width, columns);
    EXPECT_EQ(input->spec().height, rows);
    EXPECT_EQ(input->spec().nchannels, 1);
    std::vector<std::uint8_t> values(static_cast<std::size_t>(columns * rows));
    EXPECT_TRUE(input->read_image(0, 0, 0, 1, OIIO::TypeDesc::UINT8, values.data()));
    return values;
}

TEST(BlockMeans, AreOverWhatThereIs) {
    constexpr float nothing = std::numeric_limits<float>::quiet_NaN();
    Grid<float> image(5, 3);
    image.values = {1, 2, 3, 4, 5, 6, 7, nothing, nothing, 10, 11, 12, 13, 14, nothing};
    EXPECT_EQ(block_means(image, 1).values.size(), 15u);
    const auto means = block_means(image, 2);
    ASSERT_EQ(means.columns, 3);
    ASSERT_EQ(means.rows, 2);
    EXPECT_THAT(std::vector(means.values.begin(), means.values.begin() + 5), ElementsAre(4, 3.5, 7.5, 11.5, 13.5));
    EXPECT_TRUE(std::isnan(means.values[5]));
}

TEST(BlockMeans, BlocksAreTheSmallestThatSuffice) {
    EXPECT_EQ(block_for(1000, 1000, 1e6, 1000), 1);
    EXPECT_EQ(block_for(1000, 1000, 1e6 - 1, 1000), 2);
    EXPECT_EQ(block_for(4096, 4096, 6e6 / 200, 512), 24); // 171 a side
    EXPECT_EQ(block_for(5000, 2, 1e6, 512), 10);
    EXPECT_EQ(block_for(3, 3, 0.5, 512), 3); // a pixel is left
}

TEST(FrameTally, ShowsEveryImageOfAShortStack) {
    FrameTally tally(3);
    for (int k = 0; k < 3; ++k) {
        Grid<float> image(4, 2);
        for (std::size_t p = 0; p < image.values.size(); ++p)
            image.values[p] = static_cast<float>(1e-9 * static_cast<double>(p + 1) * (k + 1));
        tally.add(image, 0.1 * k);
    }
    const auto frames = tally.finish();
    EXPECT_THAT(frames.z, ElementsAre(0, 0.1, 0.2));
    ASSERT_EQ(frames.pngs.size(), 3u);
    EXPECT_NEAR(frames.white, 21e-9, 1e-12); // all but the largest of 24 values, 24e-9
    // The grid's upper row, 5 ... 8 times 2e-9, comes first.
    EXPECT_THAT(pixels_of(frames.pngs[1], 4, 2), ElementsAre(121, 146, 170, 194, 24, 49, 73, 97));
}

TEST(FrameTally, LongStacksOfLargeImagesStaySmall) {
    constexpr int images = 450, side = 402;
    FrameTally tally(images);
    Grid<float> image(side, side);
    for (int k = 0; k < images; ++k) {
        std::ranges::fill(image.values, static_cast<float>(k));
        tally.add(image, k);
    }
    const auto frames = tally.finish();
    EXPECT_EQ(frames.every, 3);
    ASSERT_EQ(frames.pngs.size(), 150u);
    EXPECT_EQ(frames.z[149], 447);
    EXPECT_EQ(frames.block, 3); // 134 a side; 201 would be 6.06e6 pixels of 6e6
    EXPECT_EQ(pixels_of(frames.pngs[75], 134, 134)[7], std::lround(225 * 255.0 / 447));
    EXPECT_TRUE(FrameTally(5).finish().pngs.empty());
}

} // namespace
} // namespace vkfv::report
