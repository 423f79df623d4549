// OpenImageIO reads the PNGs as they were drawn.
#include "images/picture.hpp"

#include "core/messages/error.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace vkfv::images {
namespace {

TEST(Png, PixelsAreThoseThatWereGiven) {
    for (const auto& [columns, rows] : {std::pair(1, 1), std::pair(7, 3), std::pair(3000, 2), std::pair(2, 900)}) {
        std::vector<std::uint8_t> pixels(static_cast<std::size_t>(3 * columns * rows));
        for (std::size_t k = 0; k < pixels.size(); ++k) {
            pixels[k] = static_cast<std::uint8_t>(k * k >> 3);
        }
        const std::string bytes = png_bytes(columns, rows, pixels);
        EXPECT_EQ(bytes, png_bytes(columns, rows, pixels));
        OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
        const auto input = OIIO::ImageInput::create("png");
        OIIO::ImageSpec spec;
        ASSERT_TRUE(input->set_ioproxy(&memory) && input->open("picture.png", spec)) << input->geterror();
        EXPECT_EQ(spec.width, columns);
        EXPECT_EQ(spec.height, rows);
        EXPECT_EQ(spec.nchannels, 3);
        std::vector<std::uint8_t> read(pixels.size());
        ASSERT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, read.data()));
        EXPECT_TRUE(read == pixels) << columns << " x " << rows;
    }
}

TEST(Png, NoPixelIsARunError) {
    EXPECT_THROW(png_bytes(0, 5, {}), RunError);
}

} // namespace
} // namespace vkfv::images
