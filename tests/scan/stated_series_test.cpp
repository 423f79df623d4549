// Files of several images state the numbers of channels, heights and frames, pitches and dates in the words of the
// programs that write them.
#include "scan/stated_series.hpp"

#include "core/messages/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

using namespace vkfv;
using images::ImageStatement;
using scan::stated_series;
using scan::StatedSeries;

namespace {

constexpr const char* file = "folder/stack.tif";

StatedSeries imagej(const std::string& lines, int pages, double per_unit = 0) {
    return stated_series(
        {.description = "ImageJ=1.53t\n" + lines, .columns_per_unit = per_unit, .rows_per_unit = per_unit}, pages,
        file);
}

StatedSeries ome(const std::string& pixels, const std::string& within, int pages) {
    return stated_series({.description = "<?xml version=\"1.0\" encoding=\"UTF-8\"?><OME "
                                         "xmlns=\"http://www.openmicroscopy.org/Schemas/OME/2016-06\"><Image "
                                         "ID=\"Image:0\"><Pixels ID=\"Pixels:0\" " +
                                         pixels + ">" + within + "</Pixels></Image></OME>"},
                         pages, file);
}

std::vector<int> pages_of(const StatedSeries& stated, int channel, int frame) {
    std::vector<int> pages;
    for (int height = 0; height < stated.heights; ++height) {
        pages.push_back(stated.page(height, channel, frame));
    }
    return pages;
}

} // namespace

TEST(StatedSeries, IsReadFromImageJ) {
    const auto stated =
        imagej("images=62\nchannels=2\nslices=31\nhyperstack=true\nunit=micron\nspacing=0.5\nzorigin=4\n", 62, 2);
    EXPECT_EQ(stated.channels, 2);
    EXPECT_EQ(stated.heights, 31);
    EXPECT_EQ(stated.frames, 1);
    EXPECT_NEAR(stated.pitch_x.value(), 0.5e-3, 1e-15);
    EXPECT_NEAR(stated.pitch_y.value(), 0.5e-3, 1e-15);
    EXPECT_NEAR(stated.z_step.value(), 0.5e-3, 1e-15);
    EXPECT_NEAR(stated.z_start.value(), -2e-3, 1e-15);
    EXPECT_EQ(stated.page(0, 1, 0), 1); // channels are the fastest
    EXPECT_EQ(stated.page(30, 0, 0), 60);
    EXPECT_TRUE(stated.doubts.empty());
}

TEST(StatedSeries, HasTheDateOfTheImages) {
    const auto dated = [](const std::string& date, const std::string& description = "") {
        return stated_series({.description = description, .date = date}, 1, file).date;
    };
    EXPECT_EQ(dated("2024:02:29 01:02:03"), "2024-02-29T01:02:03");
    EXPECT_EQ(dated("2024:02:29 01:02:03", "ImageJ=1.53t\nimages=1\n"), "2024-02-29T01:02:03");
    const std::string xml = "<OME><Image><AcquisitionDate>2023-12-01T10:00:00</AcquisitionDate>"
                            "<Pixels SizeZ=\"1\" SizeC=\"1\" SizeT=\"1\"/></Image></OME>";
    EXPECT_EQ(dated("2024:02:29 01:02:03", xml), "2023-12-01T10:00:00");
    for (const char* none : {"", "2024", "2024-02-29 01:02:03", "    :  :     :  :  ", "yesterday, at noon"}) {
        EXPECT_EQ(dated(none), "") << none;
    }
}

TEST(StatedSeries, KnowsEveryUnit) {
    for (const auto& [unit, length] : std::vector<std::pair<std::string, double>>{{"um", 1e-3},
                                                                                  {"\xc2\xb5m", 1e-3},
                                                                                  {"\xce\xbcm", 1e-3},
                                                                                  {"\xb5m", 1e-3},
                                                                                  {"\\u00B5m", 1e-3},
                                                                                  {"microns", 1e-3},
                                                                                  {"nm", 1e-6},
                                                                                  {"mm", 1},
                                                                                  {"inch", 25.4},
                                                                                  {"Microns", 1e-3},
                                                                                  {"Inch", 25.4},
                                                                                  {"\u00c5", 1e-7}}) {
        const auto stated = imagej("images=3\nslices=3\nunit=" + unit + "\nspacing=2\n", 3, 4);
        EXPECT_NEAR(stated.z_step.value(), 2 * length, 1e-12 * length) << unit;
        EXPECT_NEAR(stated.pitch_x.value(), length / 4, 1e-12 * length) << unit;
    }
    const auto pixels = imagej("images=3\nslices=3\nunit=pixel\nspacing=2\n", 3, 4);
    EXPECT_FALSE(pixels.z_step || pixels.pitch_x);
    EXPECT_THAT(pixels.doubts, testing::ElementsAre(testing::HasSubstr("without a unit")));
}

// The number is one whatever the language of the program that wrote it, and the unit whatever its capitals.
TEST(StatedSeries, ReadsNumbersAsProgramsWriteThem) {
    for (const char* two_and_a_half : {"2.5", "2,5", " 2.5 ", "+2.5", "2.5E0", "25,0e-1"}) {
        const auto stated = imagej("images=3\nslices=3\nunit=um\nspacing=" + std::string(two_and_a_half) + "\n", 3, 4);
        EXPECT_NEAR(stated.z_step.value_or(0), 2.5e-3, 1e-15) << two_and_a_half;
    }
    for (const char* none : {"NaN", "1.234,5", "1,234,5", "two", "+-2", "", " "}) {
        const auto stated = imagej("images=3\nslices=3\nunit=um\nspacing=" + std::string(none) + "\n", 3, 4);
        EXPECT_FALSE(stated.z_step) << none;
        EXPECT_THAT(stated.doubts, testing::ElementsAre(testing::HasSubstr("spacing"))) << none;
    }
    EXPECT_FALSE(imagej("images=3\nslices=3\nunit=Mm\nspacing=2\n", 3, 4).z_step);
}

// The unit of heights may be another than that of the pixels; where the text has no pitch, it follows from the tags'
// counts.
TEST(StatedSeries, HasUnitsOfEachAxis) {
    const auto stated = imagej("images=3\nslices=3\nunit=mm\nzunit=nm\nspacing=250\n", 3, 1000);
    EXPECT_NEAR(stated.pitch_x.value(), 1e-3, 1e-15);
    EXPECT_NEAR(stated.z_step.value(), 250e-6, 1e-15);
    ImageStatement by_tags{
        .description = "ImageJ=1.53t\nimages=3\nslices=3\n", .columns_per_unit = 5000, .rows_per_unit = 5000};
    by_tags.unit = ImageStatement::Unit::centimetre;
    EXPECT_NEAR(stated_series(by_tags, 3, file).pitch_x.value(), 2e-3, 1e-15);
    by_tags.description += "unit=um\nspacing=2\n"; // the statement in frames of vkfv's own stacks
    EXPECT_NEAR(stated_series(by_tags, 3, file).pitch_x.value(), 2e-3, 1e-15);
    EXPECT_NEAR(stated_series(by_tags, 3, file).z_step.value(), 2e-3, 1e-15);
}

TEST(StatedSeries, TakesFramesOfOneSliceAsHeightsAndSaysSo) {
    const auto stated = imagej("images=12\nframes=12\n", 12);
    EXPECT_EQ(stated.heights, 12);
    EXPECT_EQ(stated.frames, 1);
    EXPECT_THAT(stated.doubts, testing::ElementsAre(testing::HasSubstr("12 frames")));
    EXPECT_EQ(imagej("images=12\n", 12).heights, 12);
    EXPECT_EQ(imagej("images=12\nslices=3\nframes=4\n", 12).page(2, 0, 3), 11);
}

TEST(StatedSeries, RefusesPagesThatAreNotWhatIsStated) {
    EXPECT_THROW(imagej("images=62\nchannels=2\nslices=31\n", 61), InputError);
    EXPECT_THROW(imagej("images=5000\nslices=5000\n", 1), InputError); // one page for all, beyond 4 GB
    EXPECT_THROW(imagej("channels=1000000000\nslices=1000000000\nframes=1000000000\n", 7), InputError);
    EXPECT_THROW(ome("SizeC=\"2\" SizeZ=\"4\" SizeT=\"1\"", "", 4), InputError);
    EXPECT_THROW(ome("SizeC=\"1\" SizeZ=\"4\" SizeT=\"1\"", "<TiffData IFD=\"2\" PlaneCount=\"4\"/>", 4), InputError);
    EXPECT_THROW(ome("SizeC=\"1\" SizeZ=\"4\" SizeT=\"1\"", "<TiffData FirstZ=\"9\"/>", 4), InputError);
    EXPECT_THROW(ome("SizeC=\"1\" SizeZ=\"2\" SizeT=\"1\"",
                     "<TiffData IFD=\"0\"><UUID FileName=\"other.tif\">urn</UUID></TiffData>", 2),
                 InputError);
}

TEST(StatedSeries, IsReadFromOmeXml) {
    const auto stated =
        ome("DimensionOrder=\"XYZCT\" SizeC=\"2\" SizeZ=\"3\" SizeT=\"2\" PhysicalSizeX=\"0.9\" "
            "PhysicalSizeY=\"900\" PhysicalSizeYUnit=\"nm\" PhysicalSizeZ=\"0.002\" PhysicalSizeZUnit=\"mm\"",
            "", 12);
    EXPECT_NEAR(stated.pitch_x.value(), 0.9e-3, 1e-15); // um where no unit stands
    EXPECT_NEAR(stated.pitch_y.value(), 0.9e-3, 1e-15);
    EXPECT_NEAR(stated.z_step.value(), 2e-3, 1e-15);
    EXPECT_FALSE(stated.z_start);
    EXPECT_THAT(pages_of(stated, 1, 0), testing::ElementsAre(3, 4, 5));
    EXPECT_THAT(pages_of(stated, 0, 1), testing::ElementsAre(6, 7, 8));
}

TEST(StatedSeries, FollowsTheOrderOfDimensions) {
    for (const auto& [order, page] : std::vector<std::pair<std::string, int>>{{"XYZCT", 1 + 3 * 1},
                                                                              {"XYZTC", 1 + 3 * 2 * 1},
                                                                              {"XYCZT", 1 + 2 * 1},
                                                                              {"XYCTZ", 1 + 2 * 2 * 1},
                                                                              {"XYTCZ", 2 * 1 + 2 * 2 * 1},
                                                                              {"XYTZC", 2 * 1 + 2 * 3 * 1}}) {
        const auto stated = ome("DimensionOrder=\"" + order + "\" SizeC=\"2\" SizeZ=\"3\" SizeT=\"2\"", "", 12);
        EXPECT_EQ(stated.page(1, 1, 0), page) << order;
    }
}

TEST(StatedSeries, FollowsThePagesThatEachPlaneIsOn) {
    const auto stated = ome("DimensionOrder=\"XYZCT\" SizeC=\"1\" SizeZ=\"3\" SizeT=\"1\"",
                            "<TiffData IFD=\"2\" FirstZ=\"0\" PlaneCount=\"1\"/><TiffData IFD=\"0\" FirstZ=\"1\" "
                            "PlaneCount=\"1\"/><TiffData IFD=\"1\" FirstZ=\"2\" PlaneCount=\"1\"/>",
                            3);
    EXPECT_THAT(pages_of(stated, 0, 0), testing::ElementsAre(2, 0, 1));
    const auto whole = ome("SizeC=\"1\" SizeZ=\"3\" SizeT=\"1\"", "<TiffData/>", 3);
    EXPECT_THAT(pages_of(whole, 0, 0), testing::ElementsAre(0, 1, 2));
}

// Colour is samples of one page.
TEST(StatedSeries, TakesColourAsOneChannel) {
    const auto stated = ome("SizeC=\"3\" SizeZ=\"2\" SizeT=\"1\"", "<Channel SamplesPerPixel=\"3\"/>", 2);
    EXPECT_EQ(stated.channels, 1);
    EXPECT_EQ(stated.heights, 2);
}

TEST(StatedSeries, TakesThePlanesOwnHeights) {
    const auto planes = [](const std::vector<double>& heights, const std::string& unit) {
        std::string text;
        for (std::size_t k = 0; k < heights.size(); ++k) {
            text += fmt::format("<Plane TheZ=\"{}\" TheC=\"0\" TheT=\"0\" PositionZ=\"{}\"{}/>", k, heights[k],
                                unit.empty() ? "" : " PositionZUnit=\"" + unit + "\"");
        }
        return ome("SizeC=\"1\" SizeZ=\"3\" SizeT=\"1\" PhysicalSizeZ=\"5\"", text, 3);
    };
    const auto descending = planes({8, 6, 4}, "\xc2\xb5m");
    EXPECT_NEAR(descending.z_step.value(), -2e-3, 1e-15);
    EXPECT_NEAR(descending.z_start.value(), 8e-3, 1e-15);
    EXPECT_TRUE(descending.doubts.empty());
    EXPECT_NEAR(planes({8, 6, 4}, "").z_step.value(), 5e-3, 1e-15); // without a unit the positions do not count
    EXPECT_NEAR(planes({8, 8, 8}, "\xc2\xb5m").z_step.value(), 5e-3, 1e-15);
    EXPECT_THAT(planes({8, 7, 4}, "\xc2\xb5m").doubts, testing::ElementsAre(testing::HasSubstr("equal steps")));
}

TEST(StatedSeries, TakesTagsThatAreNoPrintersResolution) {
    ImageStatement tags{.columns_per_unit = 10000, .rows_per_unit = 10000};
    tags.unit = ImageStatement::Unit::centimetre;
    const auto fine = stated_series(tags, 4, file);
    EXPECT_EQ(fine.heights, 4);
    EXPECT_NEAR(fine.pitch_x.value(), 1e-3, 1e-15);
    tags = {.columns_per_unit = 300, .rows_per_unit = 300};
    tags.unit = ImageStatement::Unit::inch;
    const auto printed = stated_series(tags, 4, file);
    EXPECT_FALSE(printed.pitch_x);
    EXPECT_THAT(printed.doubts, testing::ElementsAre(testing::HasSubstr("printer")));
    tags.unit = ImageStatement::Unit::none;
    EXPECT_TRUE(stated_series(tags, 4, file).doubts.empty());
}

TEST(StatedSeries, PassesOverWhatIsNoStatement) {
    for (const char* text : {"", "taken on Monday", "<OME", "<OME/>", "<OME><Image/></OME>", "z = 3 um"}) {
        const auto stated = stated_series({.description = text}, 5, file);
        EXPECT_EQ(stated.heights, 5) << text;
        EXPECT_TRUE(stated.by.empty()) << text;
    }
}
