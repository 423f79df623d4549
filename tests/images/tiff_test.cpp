// libtiff reads and writes plain TIFFs: OpenImageIO reads what is written and writes what is read; of any other file
// the readers say what OpenImageIO says.
#include "images/tiff.hpp"

#include "core/messages/error.hpp"
#include "images/codec.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace vkfv::images {
namespace {

// An image of every kind of float there is, NaNs by their bits.
std::vector<Grid<float>> all_kinds(int columns, int rows, int channels) {
    using limits = std::numeric_limits<float>;
    const std::vector<float> kinds = {0.0f,
                                      -0.0f,
                                      limits::infinity(),
                                      -limits::infinity(),
                                      limits::quiet_NaN(),
                                      std::bit_cast<float>(0xffc12345u),
                                      limits::denorm_min(),
                                      limits::max(),
                                      -1.5f};
    std::vector<Grid<float>> result(static_cast<std::size_t>(channels), Grid<float>(columns, rows));
    std::size_t count = 0;
    for (Grid<float>& grid : result) {
        for (float& value : grid.values) {
            value = count % 2 == 0 ? kinds[count / 2 % kinds.size()] : static_cast<float>(count);
            ++count;
        }
    }
    return result;
}

Grid<std::uint16_t> counts(int columns, int rows) {
    Grid<std::uint16_t> grid(columns, rows);
    for (std::size_t k = 0; k < grid.values.size(); ++k) {
        grid.values[k] = static_cast<std::uint16_t>(65535 - 7 * k);
    }
    return grid;
}

template <class Value>
std::string bits_of(const std::vector<Value>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)};
}

// The values in the file's order, first row on top.
template <class Value>
std::vector<Value> from_top(std::span<const Grid<Value>> channels) {
    std::vector<Value> values;
    for (int row = channels[0].rows - 1; row >= 0; --row) {
        for (int column = 0; column < channels[0].columns; ++column) {
            for (const Grid<Value>& channel : channels) {
                values.push_back(channel(column, row));
            }
        }
    }
    return values;
}

struct Decoded {
    OIIO::ImageSpec spec;
    std::string bits;
};

Decoded decoded(const std::string& bytes) {
    OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
    const auto input = OIIO::ImageInput::create("tiff");
    Decoded result;
    EXPECT_TRUE(input->set_ioproxy(&memory) && input->open("image.tif", result.spec)) << input->geterror();
    result.bits.resize(result.spec.image_bytes());
    EXPECT_TRUE(input->read_image(0, 0, 0, result.spec.nchannels, result.spec.format, result.bits.data()));
    return result;
}

using Adjust = std::function<void(OIIO::ImageSpec&)>;

template <class Value>
std::string encoded(std::span<const Grid<Value>> channels, OIIO::TypeDesc type, const Adjust& adjust) {
    OIIO::ImageSpec spec(channels[0].columns, channels[0].rows, static_cast<int>(channels.size()), type);
    spec.attribute("compression", "none");
    spec.attribute("tiff:RowsPerStrip", channels[0].rows);
    adjust(spec);
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    const auto output = OIIO::ImageOutput::create("tiff");
    EXPECT_TRUE(output->set_ioproxy(&memory) && output->open("image.tif", spec));
    EXPECT_TRUE(
        output->write_image(type == OIIO::TypeDesc::UINT16 ? type : OIIO::TypeDesc::FLOAT, from_top(channels).data()));
    EXPECT_TRUE(output->close());
    return {bytes.begin(), bytes.end()};
}

// The result of a reader as text, or the message of its error.
template <class Read>
std::string outcome(const Read& read) {
    try {
        return read();
    } catch (const std::exception& error) {
        return std::string("error: ") + error.what();
    }
}

template <class Image>
std::string told(const Image& image) {
    return fmt::format("{} x {} '{}' ", image.values.columns, image.values.rows, image.description) +
           bits_of(image.values.values);
}

std::string told(const std::vector<Grid<float>>& channels) {
    std::string text = fmt::format("{} channels", channels.size());
    for (const Grid<float>& channel : channels) {
        text += fmt::format(" {} x {} ", channel.columns, channel.rows) + bits_of(channel.values);
    }
    return text;
}

class PlainTiffs : public testing::Test {
  protected:
    ~PlainTiffs() override { std::filesystem::remove(path_); }

    // All readers tell of these bytes what the module tells.
    void expect_as_the_module(const std::string& bytes, const std::string& what) {
        constexpr std::uint64_t most = 1000;
        const Codec& module = codec();
        const auto same = [&](const char* reader, const auto& ours, const auto& its) {
            EXPECT_EQ(outcome(ours), outcome(its)) << reader << ": " << what;
        };
        same(
            "parse_tiff", [&] { return told(parse_tiff(bytes, "a.tif")); },
            [&] { return told(module.parse_tiff(bytes, "a.tif")); });
        same(
            "parse_image", [&] { return told(parse_image(bytes, "a.tif")); },
            [&] { return told(module.parse_image(bytes, "a.tif")); });
        same(
            "parse_grey", [&] { return told({parse_grey(bytes, most, "a.tif")}); },
            [&] { return told({module.parse_grey(bytes, most, "a.tif")}); });
        std::ofstream(path_, std::ios::binary) << bytes;
        same(
            "read_image", [&] { return told({read_image(path_, 0)}); },
            [&] { return told({module.read_image(path_, 0)}); });
        same(
            "read_channels", [&] { return told(read_channels(path_, 0)); },
            [&] { return told(module.read_channels(path_, 0)); });
        same(
            "page_count", [&] { return std::to_string(page_count(path_)); },
            [&] { return std::to_string(module.page_count(path_)); });
    }

    std::filesystem::path path_ =
        std::filesystem::path(testing::TempDir()) / ("vkfv_plain_tiff_" + std::to_string(::getpid()) + ".tif");
};

const ImageTags tags = {.pitch_x = 0.002, .pitch_y = 0.004, .description = "z_um = 3\nand more"};

TEST_F(PlainTiffs, OpenImageIOReadsWhatIsWritten) {
    for (const auto& [columns, rows] : {std::pair(1, 1), std::pair(5, 3), std::pair(20000, 2), std::pair(3, 700)}) {
        for (int channels = 1; channels <= 4; ++channels) {
            const auto image = all_kinds(columns, rows, channels);
            const std::string bytes = tiff_bytes(image, tags);
            EXPECT_EQ(bytes, tiff_bytes(image, tags));
            const Decoded read = decoded(bytes);
            EXPECT_EQ(read.spec.nchannels, channels);
            EXPECT_EQ(read.spec.format, OIIO::TypeDesc::FLOAT);
            EXPECT_EQ(read.spec.get_string_attribute("ImageDescription"), tags.description);
            EXPECT_EQ(read.spec.get_string_attribute("ResolutionUnit"), "cm");
            EXPECT_EQ(read.spec.get_float_attribute("XResolution"), 5000.0f);
            EXPECT_EQ(read.spec.get_float_attribute("YResolution"), 2500.0f);
            EXPECT_TRUE(read.bits == bits_of(from_top(std::span(image)))) << columns << " x " << rows;
            // libtiff cannot say what the second of two channels is: OpenImageIO reads them.
            EXPECT_EQ(plain_tiff(bytes, TiffPart::all).has_value(), channels != 2);
            expect_as_the_module(bytes, fmt::format("{} x {} x {}", columns, rows, channels));
        }
        const auto image = counts(columns, rows);
        const std::string bytes = tiff_bytes(image);
        const Decoded read = decoded(bytes);
        EXPECT_EQ(read.spec.format, OIIO::TypeDesc::UINT16);
        EXPECT_EQ(read.spec.find_attribute("XResolution"), nullptr);
        EXPECT_TRUE(read.bits == bits_of(from_top(std::span(&image, 1))));
        EXPECT_TRUE(plain_tiff(bytes, TiffPart::all));
        expect_as_the_module(bytes, fmt::format("{} x {} counts", columns, rows));
    }
}

TEST_F(PlainTiffs, WhatOpenImageIOWroteIsRead) {
    const auto describe = [](OIIO::ImageSpec& spec) { spec.attribute("ImageDescription", "of before"); };
    for (const int channels : {1, 3, 4}) {
        const auto image = all_kinds(5, 3, channels);
        const std::string bytes = encoded(std::span(image), OIIO::TypeDesc::FLOAT, describe);
        const auto read = plain_tiff(bytes, TiffPart::all);
        ASSERT_TRUE(read) << channels;
        EXPECT_EQ(read->description, "of before");
        for (int channel = 0; channel < channels; ++channel) {
            EXPECT_EQ(bits_of(read->channel<float>(channel).values),
                      bits_of(image[static_cast<std::size_t>(channel)].values));
        }
    }
    const auto image = counts(4, 3);
    const auto read = plain_tiff(encoded(std::span(&image, 1), OIIO::TypeDesc::UINT16, describe), TiffPart::all);
    ASSERT_TRUE(read);
    EXPECT_EQ(read->channel<double>(0).values, std::vector<double>(image.values.begin(), image.values.end()));
}

TEST_F(PlainTiffs, BytesAreReadAsWritten) {
    Grid<std::uint8_t> image(5, 3);
    for (std::size_t k = 0; k < image.values.size(); ++k) {
        image.values[k] = static_cast<std::uint8_t>(255 - 17 * k);
    }
    const std::string bytes = tiff_bytes(image, tags);
    const auto read = plain_tiff(bytes, TiffPart::all);
    ASSERT_TRUE(read);
    EXPECT_TRUE(read->integers);
    EXPECT_EQ(read->channel<std::uint8_t>(0).values, image.values);
    expect_as_the_module(bytes, "bytes");
}

TEST_F(PlainTiffs, OtherKindsAreLeftToOpenImageIO) {
    const auto image = all_kinds(40, 36, 1);
    const auto float_type = OIIO::TypeDesc::FLOAT;
    const auto set = [](const char* name, auto value) {
        return [=](OIIO::ImageSpec& spec) { spec.attribute(name, value); };
    };
    const auto none = [](OIIO::ImageSpec&) {};
    const auto tiled = [](OIIO::ImageSpec& spec) { spec.tile_width = spec.tile_height = 16; };
    const std::map<std::string, std::string> files = {
        {"compressed", encoded(std::span(image), float_type, set("compression", "zip"))},
        {"several strips", encoded(std::span(image), float_type, set("tiff:RowsPerStrip", 5))},
        {"tiled", encoded(std::span(image), float_type, tiled)},
        {"offsets of 8 bytes", encoded(std::span(image), float_type, set("tiff:bigtiff", 1))},
        {"turned", encoded(std::span(image), float_type, set("Orientation", 3))},
        {"a tag more", encoded(std::span(image), float_type, set("Copyright", "somebody"))},
        {"digest", encoded(std::span(image), float_type, set("ImageDescription", "a oiio:SHA-1=12ab b"))},
        {"double", encoded(std::span(image), OIIO::TypeDesc::DOUBLE, none)},
        {"signed", encoded(std::span(image), OIIO::TypeDesc::INT16, none)},
        {"no image", "not an image at all"},
        {"empty", ""}};
    for (const auto& [what, bytes] : files) {
        EXPECT_FALSE(plain_tiff(bytes, TiffPart::all)) << what;
        expect_as_the_module(bytes, what);
    }
}

TEST_F(PlainTiffs, PagesAreOpenImageIOs) {
    const auto image = all_kinds(4, 3, 1);
    OIIO::ImageSpec spec(4, 3, 1, OIIO::TypeDesc::FLOAT);
    spec.attribute("compression", "none");
    const auto output = OIIO::ImageOutput::create("tiff");
    for (const auto mode : {OIIO::ImageOutput::Create, OIIO::ImageOutput::AppendSubimage}) {
        ASSERT_TRUE(output->open(path_.string(), spec, mode)) << output->geterror();
        ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, from_top(std::span(image)).data()));
    }
    output->close();
    EXPECT_FALSE(plain_tiff_file(path_, TiffPart::header));
    EXPECT_EQ(page_count(path_), 2);
    EXPECT_EQ(bits_of(read_image(path_, 1).values), bits_of(image[0].values));
    EXPECT_EQ(read_channels(path_, 1).size(), 1u);
    EXPECT_THROW(read_image(path_, 2), InputError);
    std::ifstream stream(path_, std::ios::binary);
    expect_as_the_module({std::istreambuf_iterator<char>(stream), {}}, "two pages");
}

// Each byte of a directory is changed, and a file is cut off at many places.
TEST_F(PlainTiffs, DamagedFilesGiveWhatOpenImageIOGives) {
    Grid<float> heights(4, 3);
    for (std::size_t k = 0; k < 12; ++k) {
        heights.values[k] = static_cast<float>(k) - 0.5f;
    }
    for (const std::string& whole : {tiff_bytes(heights, tags), tiff_bytes(std::vector(4, heights))}) {
        ASSERT_TRUE(plain_tiff(whole, TiffPart::all));
        int harmless = 0; // another letter of the description
        const std::size_t values = whole.find(bits_of(std::vector<float>{heights(0, 2)}));
        for (std::size_t at = 0; at < values; ++at) {
            std::string bytes = whole;
            bytes[at] = static_cast<char>(bytes[at] ^ 7);
            if (plain_tiff(bytes, TiffPart::all)) { // else the module is asked anyway
                expect_as_the_module(bytes, fmt::format("byte {}", at));
                ++harmless;
            }
        }
        EXPECT_GT(harmless, 20);
        for (std::size_t length = 0; length < whole.size(); length += 7) {
            EXPECT_FALSE(plain_tiff(whole.substr(0, length), TiffPart::all));
            expect_as_the_module(whole.substr(0, length), fmt::format("{} bytes", length));
        }
    }
}

TEST_F(PlainTiffs, HeightsAndMasksHaveRulesOfTheirOwn) {
    const auto refused = [](const std::string& bytes) {
        return outcome([&] { return told({parse_grey(bytes, 100, "a.tif")}); });
    };
    using testing::HasSubstr;
    EXPECT_THAT(refused(tiff_bytes(Grid<float>(1, 5, 1.0f))), HasSubstr("1 x 5 x 1 pixels"));
    EXPECT_THAT(refused(tiff_bytes(Grid<float>(11, 10, 1.0f))), HasSubstr("at most 100 pixels"));
    EXPECT_THAT(refused(tiff_bytes(all_kinds(3, 3, 1))), HasSubstr("finite values"));
    EXPECT_EQ(parse_grey(tiff_bytes(Grid<std::uint16_t>(2, 2, 65535)), 100, "a.tif").values,
              std::vector<float>(4, 1.0f)); // scaled, as OpenImageIO does
    EXPECT_EQ(parse_grey(tiff_bytes(Grid<float>(10, 10, 2.5f)), 100, "a.tif").values, std::vector<float>(100, 2.5f));
}

TEST_F(PlainTiffs, NoPixelIsARunError) {
    EXPECT_THROW(tiff_bytes(Grid<float>()), RunError);
}

} // namespace
} // namespace vkfv::images
