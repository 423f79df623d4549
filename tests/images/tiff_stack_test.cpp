// OpenImageIO reads each page of a stack in one TIFF; by ImageJ's rule all values stand in one block, first to last.
#include "images/tiff_stack.hpp"

#include "images/image_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>

namespace vkfv::images {
namespace {

using testing::HasSubstr;

TiffStack three_of(PixelBits bits) {
    return {.columns = 3,
            .rows = 2,
            .bits = bits,
            .pitch = 0.345,
            .first = -1.5,
            .step = 0.75,
            .notes = "values=W\n",
            .pages = {"z_um=-1.5", "z_um=-0.75", "z_um=0"}};
}

Grid<float> image(int number) {
    Grid<float> grid(3, 2);
    for (std::size_t k = 0; k < grid.values.size(); ++k) {
        grid.values[k] = static_cast<float>(10 * number) + static_cast<float>(k);
    }
    return grid;
}

template <class Value>
std::string file_of(PixelBits bits) {
    std::string bytes = tiff_stack_head(three_of(bits));
    for (int number = 0; number < 3; ++number) {
        const auto floats = image(number);
        Grid<Value> values(floats.columns, floats.rows);
        std::ranges::transform(floats.values, values.values.begin(), [](float value) { return Value(value); });
        bytes += tiff_stack_values(values);
    }
    return bytes;
}

class TiffStacks : public testing::Test {
  protected:
    ~TiffStacks() override { std::filesystem::remove(path); }
    void expect_pages(const std::string& bytes) const {
        std::ofstream(path, std::ios::binary) << bytes;
        ASSERT_EQ(page_count(path), 3);
        for (int number = 0; number < 3; ++number) {
            EXPECT_EQ(read_image(path, number).values, image(number).values) << number;
        }
    }
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("vkfv_stack_" + std::to_string(getpid()) + ".tif");
};

TEST_F(TiffStacks, EachPageIsItsImage) {
    expect_pages(file_of<float>(PixelBits::float32));
    EXPECT_THAT(image_statement(path).description, HasSubstr("images=3\nslices=3\nunit=um\nspacing=0.75\nzorigin=2\n"));
    EXPECT_THAT(image_statement(path).description, HasSubstr("values=W\n"));
    expect_pages(file_of<std::uint16_t>(PixelBits::uint16));
    expect_pages(file_of<std::uint8_t>(PixelBits::uint8));
}

TEST_F(TiffStacks, ValuesStandInOneBlockTheHighestRowFirst) {
    const std::string head = tiff_stack_head(three_of(PixelBits::float32));
    const std::string bytes = file_of<float>(PixelBits::float32);
    EXPECT_EQ(bytes.size(), head.size() + 3 * 6 * sizeof(float));
    float first = 0, last = 0;
    std::memcpy(&first, bytes.data() + head.size(), sizeof first);
    std::memcpy(&last, bytes.data() + bytes.size() - sizeof last, sizeof last);
    EXPECT_EQ(first, image(0)(0, 1));
    EXPECT_EQ(last, image(2)(2, 0));
}

// The head alone is made: the values would be 6 GB.
TEST(TiffStack, IsABigTiffBeyondFourGigabytes) {
    TiffStack stack = three_of(PixelBits::float32);
    const auto version = [&] {
        const std::string head = tiff_stack_head(stack);
        return int{head[2]};
    };
    stack.columns = stack.rows = 18000; // 3.9 GB
    EXPECT_EQ(version(), 42);
    stack.columns = stack.rows = 22000;
    EXPECT_EQ(version(), 43);
    const std::string head = tiff_stack_head(stack);
    // The header has 16 bytes; then comes a directory: number of entries, then entries of 20 bytes in ascending order.
    std::uint64_t entries = 0;
    std::memcpy(&entries, head.data() + 16, sizeof entries);
    std::uint16_t before = 0;
    std::uint64_t values = 0;
    for (std::uint64_t k = 0; k < entries; ++k) {
        std::uint16_t tag = 0;
        std::memcpy(&tag, head.data() + 24 + 20 * k, sizeof tag);
        EXPECT_GT(tag, before);
        before = tag;
        if (tag == 273) {
            std::memcpy(&values, head.data() + 24 + 20 * k + 12, sizeof values);
        }
    }
    EXPECT_EQ(values, head.size());
}

} // namespace
} // namespace vkfv::images
