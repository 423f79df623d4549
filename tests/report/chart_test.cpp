// Values that are drawn stand where their numbers say, and read in the right way up.
#include "report/chart.hpp"
#include "report/contact_sheet.hpp"
#include "report/png.hpp"
#include "report/topography_picture.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <pugixml.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace vkfv {
namespace {

using namespace report;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::string bytes_of(const std::string& text) { // base64, RFC 4648
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    unsigned word = 0, bits = 0;
    for (const char c : text)
        if (const auto digit = digits.find(c); digit != std::string::npos) {
            word = word << 6 | static_cast<unsigned>(digit);
            bits += 6;
            if (bits >= 8)
                bytes += static_cast<char>(word >> (bits -= 8) & 255);
        }
    return bytes;
}

// The pixels of a PNG as OpenImageIO reads them, first row on top.
std::vector<std::uint8_t> decoded(std::string png, int& columns, int& rows) {
    OIIO::Filesystem::IOMemReader source(png.data(), png.size());
    OIIO::ImageSpec config;
    void* proxy = &source;
    config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    const auto input = OIIO::ImageInput::open("picture.png", &config);
    EXPECT_TRUE(input) << OIIO::geterror();
    columns = input->spec().width;
    rows = input->spec().height;
    std::vector<std::uint8_t> values(static_cast<std::size_t>(columns * rows * 3));
    EXPECT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, values.data()));
    return values;
}

pugi::xml_document parsed(const std::string& svg) {
    pugi::xml_document document;
    const auto result = document.load_string(svg.c_str());
    EXPECT_TRUE(result) << result.description();
    return document;
}

std::vector<pugi::xml_node> all(const pugi::xml_node& root, const char* name) {
    std::vector<pugi::xml_node> found;
    for (const auto& match : root.select_nodes((std::string("//") + name).c_str()))
        found.push_back(match.node());
    return found;
}

std::string png_of(const pugi::xml_node& image) {
    const std::string reference = image.attribute("href").value();
    const std::string head = "data:image/png;base64,";
    EXPECT_TRUE(reference.starts_with(head));
    return bytes_of(reference.substr(head.size()));
}

TEST(Png, HoldsThePixelsWithTheLowestRowLast) {
    Grid<Rgb> pixels(2, 3);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 2; ++column)
            pixels(column, row) = {static_cast<std::uint8_t>(10 * row + column), 7,
                                   static_cast<std::uint8_t>(200 + row)};
    int columns = 0, rows = 0;
    const auto values = decoded(bytes_of(base64(png_bytes(pixels))), columns, rows);
    EXPECT_EQ(columns, 2);
    EXPECT_EQ(rows, 3);
    EXPECT_EQ(values,
              (std::vector<std::uint8_t>{20, 7, 202, 21, 7, 202, 10, 7, 201, 11, 7, 201, 0, 7, 200, 1, 7, 200}));
    EXPECT_EQ(png_bytes(pixels), png_bytes(pixels));
}

TEST(Base64, IsThatOfRfc4648) {
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

TEST(Colours, GrowBrighterWithTheHeight) {
    double last = -1;
    for (int k = 0; k <= 32; ++k) {
        const Rgb colour = colour_of(Palette::height, k / 32.0);
        const double brightness = 0.30 * colour.red + 0.59 * colour.green + 0.11 * colour.blue; // NTSC luma
        EXPECT_GT(brightness, last);
        last = brightness;
    }
    const Rgb middle = colour_of(Palette::signed_deviation, 0.5), low = colour_of(Palette::signed_deviation, 0),
              high = colour_of(Palette::signed_deviation, 1);
    EXPECT_EQ(middle.red + middle.green + middle.blue, 3 * 255);
    EXPECT_GT(low.blue, low.red);
    EXPECT_GT(high.red, high.blue);
}

TEST(Ticks, AreRoundNumbersWithinTheEnds) {
    EXPECT_EQ(ticks(0, 10, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
    EXPECT_EQ(ticks(-0.5, 0.5, 4), (std::vector<double>{-0.5, 0, 0.5}));
    EXPECT_EQ(ticks(3, 3, 5), std::vector<double>{3});
    // A double does not tell the steps of these ranges apart.
    for (const double from : {1.0, -1.0, 1e300, 1e-300}) {
        EXPECT_LE(ticks(from, std::nextafter(from, INFINITY), 5).size(), 12u) << from;
    }
    EXPECT_LE(ticks(0, 5e-324, 5).size(), 12u);
    EXPECT_LE(ticks(-1.7e308, 1.7e308, 5).size(), 12u);
    EXPECT_EQ(with_prefix(12345678), "12.3 M");
}

TEST(RangeOf, LeavesOutTheShareThatIsAskedFor) {
    Grid<double> values(101, 1);
    for (int k = 0; k <= 100; ++k)
        values(k, 0) = k;
    const auto [low, high] = range_of(values, 0.1);
    EXPECT_EQ(low, 5);
    EXPECT_EQ(high, 95);
    EXPECT_EQ(range_of(Grid<double>(3, 3, nan), 0), (std::pair{0.0, 1.0}));
}

TEST(Chart, PointsStandBetweenTheTicksOfTheirValues) {
    const std::vector<Curve> curves = {
        {.name = "a", .points = {{1, 10}, {10, 100}, {100, 1000}}, .spreads = {}, .markers = true}};
    Svg svg;
    draw_chart(svg, {0, 0}, {400, 300}, "T", axis_over(curves, 0, "N", true), axis_over(curves, 1, "y", true), curves);
    const auto document = parsed(svg.document({400, 300}, "T"));
    std::vector<glm::dvec2> markers;
    for (const auto& rectangle : all(document, "rect"))
        if (rectangle.attribute("width").as_double() == 6)
            markers.emplace_back(rectangle.attribute("x").as_double() + 3, rectangle.attribute("y").as_double() + 3);
    ASSERT_EQ(markers.size(), 3u);
    // The second marker lies in the middle of the others on logarithmic axes; y of the page goes down.
    EXPECT_NEAR(markers[1].x, 0.5 * (markers[0].x + markers[2].x), 0.02);
    EXPECT_NEAR(markers[1].y, 0.5 * (markers[0].y + markers[2].y), 0.02);
    EXPECT_GT(markers[0].y, markers[2].y);
    bool labelled = false;
    for (const auto& text : all(document, "text"))
        labelled = labelled || (std::string(text.child_value()) == "10" &&
                                std::abs(text.attribute("x").as_double() - markers[1].x) < 0.02);
    EXPECT_TRUE(labelled);
}

TEST(Map, ShowsTheUpperRowOnTopAndGapsInTheirColour) {
    report::Map map;
    map.values = Grid<double>(2, 2);
    map.values(0, 0) = 0;
    map.values(1, 0) = nan;
    map.values(0, 1) = 1;
    map.values(1, 1) = 1;
    map.palette = Palette::grey;
    Svg svg;
    draw_map(svg, {0, 0}, {300, 300}, map);
    const auto document = parsed(svg.document({300, 300}, ""));
    int columns = 0, rows = 0;
    const auto values = decoded(png_of(all(document, "image").front()), columns, rows);
    EXPECT_EQ(values, (std::vector<std::uint8_t>{255, 255, 255, 255, 255, 255, 0, 0, 0, not_measured_colour.red,
                                                 not_measured_colour.green, not_measured_colour.blue}));
}

TEST(Map, KeepsItsShapeAndItsPlacesWhenItsValuesAreAveraged) {
    // The map has 3000 x 500 values, twice as high as wide: it is drawn 3 by 1. The block of ones ends at three eighths
    // of the width.
    Map map{.title = "", .values = Grid<double>(3000, 500, 0.0), .pitch = {1, 2}};
    for (int row = 0; row < 500; ++row)
        for (int column = 0; column < 1125; ++column)
            map.values(column, row) = 1;
    map.palette = Palette::grey;
    Svg svg;
    draw_map(svg, {0, 0}, {300, 300}, map);
    const auto document = parsed(svg.document({300, 300}, ""));
    const auto image = all(document, "image").front();
    EXPECT_NEAR(image.attribute("width").as_double(), 3 * image.attribute("height").as_double(), 0.02);
    int columns = 0, rows = 0;
    const auto values = decoded(png_of(image), columns, rows);
    EXPECT_LE(columns, std::ceil(2 * image.attribute("width").as_double()));
    EXPECT_LE(rows, std::ceil(2 * image.attribute("height").as_double()));
    int ones = 0;
    for (int column = 0; column < columns; ++column)
        ones += values[static_cast<std::size_t>(3 * column)] == 255;
    EXPECT_NEAR(ones, 0.375 * columns, 1);
}

TEST(TopographyPicture, HasAPanelForEachMapAndTheProfile) {
    surface::HeightMap heights{
        .height = Grid<double>(8, 6, 0.001), .x0 = -0.01, .y0 = 0, .pitch_x = 0.002, .pitch_y = 0.002};
    heights.height(3, 3) = nan;
    const auto document = parsed(topography_picture({.title = "a < b",
                                                     .measured = heights,
                                                     .truth = heights,
                                                     .deviation = heights,
                                                     .all_in_focus = Grid<float>(8, 6, 1.0f),
                                                     .charts = {}}));
    // The images are five maps and the colour bars of them all.
    EXPECT_EQ(all(document, "image").size(), 10u);
    EXPECT_STREQ(document.child("svg").child("title").child_value(), "a < b");
}

TEST(ImagePicture, StatesMeanAndContrast) {
    Grid<double> image(4, 2, 1.0);
    for (int column = 0; column < 4; ++column)
        image(column, 1) = 3.0;
    const auto svg = image_picture("t", image, 0, 0, 0.001, light_of_pixels);
    EXPECT_NE(svg.find("Mean 2 W, contrast 0.5000"), std::string::npos);
}

TEST(ContactSheet, RowsAndColumnsStandInTheirOrder) {
    ContactSheet sheet;
    sheet.row_label = "g";
    sheet.column_label = "N";
    sheet.row_values = {"0.3", "1"};
    sheet.column_values = {"1e7", "1e8", "1e9"};
    for (int k = 0; k < 6; ++k) {
        sheet.images.emplace_back(2, 2, 1.0f);
        sheet.notes.push_back("note " + std::to_string(k));
    }
    const auto document = parsed(contact_sheet(sheet));
    const auto images = all(document, "image");
    ASSERT_EQ(images.size(), 6u);
    EXPECT_LT(images[0].attribute("x").as_double(), images[2].attribute("x").as_double());
    EXPECT_LT(images[2].attribute("y").as_double(), images[3].attribute("y").as_double());
    // Each image has its own mean in the middle of the scale.
    int columns = 0, rows = 0;
    EXPECT_EQ(decoded(png_of(images[0]), columns, rows).front(), 128);
}

} // namespace
} // namespace vkfv
