// --topography of stacks that vkfv did not make.
#include "app/program.hpp"
#include "images/image_file.hpp"
#include "scan/image_order.hpp"
#include "support/surface_files.hpp"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace vkfv::test {
namespace {

using ::testing::HasSubstr;

constexpr int side = 24, images = 12;

// Texture whose contrast is exp(-(k - height)^2 / 4) in image k: sharp at 4 on the left and at 7.25 on the right.
double height_at(int column) {
    return column < side / 2 ? 4 : 7.25;
}

std::vector<std::vector<int>> stack_values(int largest) {
    std::mt19937 random(3);
    std::vector<double> texture(side * side);
    for (double& value : texture)
        value = static_cast<double>(random() % 1000) / 1000 - 0.5;
    std::vector<std::vector<int>> stack;
    for (int k = 0; k < images; ++k) {
        std::vector<int>& image = stack.emplace_back();
        for (int p = 0; p < side * side; ++p)
            image.push_back(static_cast<int>(
                std::lround(largest * (0.5 + texture[static_cast<std::size_t>(p)] *
                                                 std::exp(-std::pow(k - height_at(p % side), 2) / 4)))));
    }
    return stack;
}

template <class Value>
void write_pages(const std::filesystem::path& path, const std::vector<std::vector<int>>& stack, int channels,
                 OIIO::TypeDesc type) {
    const auto output = OIIO::ImageOutput::create("tiff");
    OIIO::ImageSpec spec(side, side, channels, type);
    std::vector<OIIO::ImageSpec> specs(stack.size(), spec);
    ASSERT_TRUE(output->open(path.string(), static_cast<int>(specs.size()), specs.data()));
    for (std::size_t k = 0; k < stack.size(); ++k) {
        if (k > 0) {
            ASSERT_TRUE(output->open(path.string(), spec, OIIO::ImageOutput::AppendSubimage));
        }
        std::vector<Value> values;
        for (const int value : stack[k])
            values.insert(values.end(), static_cast<std::size_t>(channels), static_cast<Value>(value));
        ASSERT_TRUE(output->write_image(type, values.data()));
    }
    ASSERT_TRUE(output->close());
}

ProgramResult evaluate(const std::filesystem::path& folder, const std::string& stack, const std::string& out,
                       const std::vector<std::string>& further = {}) {
    std::vector<std::string> arguments = {"--topography", stack,
                                          "--z_step_um",  "0.5",
                                          "--pitch_um",   "2",
                                          "--out",        out,
                                          "--set",        "topography.window_px=3",
                                          "--set",        "topography.smoothing_steps=0"};
    arguments.insert(arguments.end(), further.begin(), further.end());
    return run_program(arguments, folder);
}

TEST(Topography, ATiffOfPagesAndAFolderInNaturalOrderGiveTheSameHeights) {
    const auto folder = fresh_folder("foreign");
    const auto stack = stack_values(60000);
    write_pages<std::uint16_t>(folder / "stack.tif", stack, 1, OIIO::TypeDesc::UINT16);
    std::filesystem::create_directory(folder / "images");
    write_file(folder / "images/notes.txt", "no image");
    for (std::size_t k = 0; k < stack.size(); ++k)
        write_pages<std::uint16_t>(folder / "images" / fmt::format("z{}.tif", k), {stack[k]}, 1,
                                   OIIO::TypeDesc::UINT16);
    for (const char* name : {"stack.tif", "images"}) {
        const auto result = evaluate(folder, name, std::string("of_") + name);
        ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    }
    for (const char* file : {"topography.tif", "quality.tif", "fit_residual.tif", "mask.tif", "all_in_focus.tif"})
        EXPECT_EQ(read_file(folder / "of_stack.tif" / file), read_file(folder / "of_images" / file)) << file;
    EXPECT_FALSE(std::filesystem::exists(folder / "of_images/truth.tif"));

    const auto map = surface::read_height_map(folder / "of_images/topography.tif");
    EXPECT_NEAR(map.pitch_x, 0.002, 1e-15);
    // The contrast is Gaussian along z, but it is divided by a brightness that rises with it by up to 0.2 of 0.5 (the
    // mean of 9 texture values of standard deviation 0.29): a symmetric change of the curve's shape, which between
    // steps shifts the three-point fit by less than a hundredth of a step of 0.5 um.
    for (const int column : {5, 18})
        for (const int row : {5, 18})
            EXPECT_NEAR(map.height(column, row), height_at(column) * 0.5e-3, 5e-6) << column << " " << row;
    // Each pixel is between those of the two images around its height: the fourth on the left and near the seventh on
    // the right, to what a hundredth of a step takes from its neighbour and rounding to whole values.
    const auto focused = images::read_image(folder / "of_images/all_in_focus.tif");
    for (const int row : {5, 18}) {
        const auto in_file = static_cast<std::size_t>((side - 1 - row) * side);
        const auto expect_near = [&](int column, int image) {
            const auto at = in_file + static_cast<std::size_t>(column);
            const double place = height_at(column), share = std::abs(place - image);
            const std::size_t other = static_cast<std::size_t>(place > image ? image + 1 : image - 1);
            const double here = stack[static_cast<std::size_t>(image)][at], there = stack[other][at];
            EXPECT_NEAR(focused(column, row), here + share * (there - here), 0.012 * std::abs(there - here) + 1);
        };
        expect_near(5, 4);
        expect_near(18, 7);
    }
    const auto results = nlohmann::json::parse(read_file(folder / "of_images/results.json"));
    EXPECT_EQ(results["z_step_um"], 0.5);
    EXPECT_GT(results["measured_share"], 0.9);
    EXPECT_FALSE(results.contains("correlation"));
}

TEST(Topography, DepthOfPixelsAndColourDoNotChangeHeights) {
    const auto folder = fresh_folder("kinds");
    const auto stack = stack_values(255);
    write_pages<std::uint8_t>(folder / "grey.tif", stack, 1, OIIO::TypeDesc::UINT8);
    write_pages<std::uint8_t>(folder / "colour.tif", stack, 3, OIIO::TypeDesc::UINT8);
    write_pages<float>(folder / "float.tif", stack, 1, OIIO::TypeDesc::FLOAT);
    for (const char* name : {"grey", "colour", "float"}) {
        const auto result = evaluate(folder, std::string(name) + ".tif", name);
        ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    }
    const auto grey = surface::read_height_map(folder / "grey/topography.tif").height.values;
    const auto colour = surface::read_height_map(folder / "colour/topography.tif").height.values;
    EXPECT_EQ(read_file(folder / "float/topography.tif"), read_file(folder / "grey/topography.tif"));
    for (std::size_t k = 0; k < grey.size(); ++k) {
        ASSERT_EQ(std::isnan(grey[k]), std::isnan(colour[k]));
        if (!std::isnan(grey[k])) {
            EXPECT_NEAR(colour[k], grey[k],
                        1e-8); // the curve's float32 over the peak's curvature of some 0.2, in 0.5 um
        }
    }
    EXPECT_EQ(images::read_channels(folder / "colour/all_in_focus.tif").size(), 3u);
}

TEST(Topography, ADescendingStackHasItsHeightsTheOtherWay) {
    const auto folder = fresh_folder("descending");
    write_pages<std::uint16_t>(folder / "up.tif", stack_values(60000), 1, OIIO::TypeDesc::UINT16);
    auto reversed = stack_values(60000);
    std::ranges::reverse(reversed);
    write_pages<std::uint16_t>(folder / "down.tif", reversed, 1, OIIO::TypeDesc::UINT16);
    ASSERT_EQ(evaluate(folder, "up.tif", "up").exit_code, 0);
    const auto result =
        run_program({"--topography", "down.tif", "--z-step-um", "-0.5", "--pitch-um", "2", "--z-start-um", "5.5",
                     "--out", "down", "--set", "topography.window_px=3", "--set", "topography.smoothing_steps=0"},
                    folder);
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    EXPECT_EQ(read_file(folder / "up/topography.tif"), read_file(folder / "down/topography.tif"));
}

// A flat of the same instrument: what a polynomial of it is comes off; another grid is not the same instrument.
TEST(Topography, AMeasuredFlatTakesTheFieldCurvatureOff) {
    const auto folder = fresh_folder("flat");
    write_pages<std::uint16_t>(folder / "stack.tif", stack_values(60000), 1, OIIO::TypeDesc::UINT16);
    surface::HeightMap flat{.height = Grid<double>(side, side), .x0 = 7, .y0 = -3, .pitch_x = 0.002, .pitch_y = 0.002};
    const auto curvature = [](int column, int row) { return 1e-5 * column - 1e-6 * row * row; }; // mm
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column)
            flat.height(column, row) = curvature(column, row);
    surface::write_height_map(folder / "flat.tif", flat);
    ASSERT_EQ(evaluate(folder, "stack.tif", "raw").exit_code, 0);
    const auto result = evaluate(folder, "stack.tif", "corrected", {"--set", "topography.flatness_file=flat.tif"});
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    const auto raw = surface::read_height_map(folder / "raw/topography.tif");
    const auto corrected = surface::read_height_map(folder / "corrected/topography.tif");
    for (const int column : {0, 5, 18})
        for (const int row : {2, 18})
            if (const double height = raw.height(column, row); !std::isnan(height)) {
                // Files hold float32: 6e-8 of 4 um.
                EXPECT_NEAR(corrected.height(column, row), height - curvature(column, row), 1e-9)
                    << column << " " << row;
            }
    const auto results = nlohmann::json::parse(read_file(folder / "corrected/results.json"));
    // Over columns and rows of 0 to 23. Levelled, the parabola is left: 11.5^2 - 0.5^2 times 1e-3 um, of which the
    // S-filter of three pixels rounds a little off.
    EXPECT_NEAR(results["flatness"]["polynomial_peak_to_valley_um"], 0.23 + 0.529, 1e-3);
    EXPECT_NEAR(results["flatness"]["z_flt_um"], 0.132, 0.015);
    EXPECT_NEAR(results["flatness"]["z_flt_s_filter_um"], 6, 1e-9);
    EXPECT_EQ(results["flatness"]["file"], "flat.tif");
    EXPECT_FALSE(nlohmann::json::parse(read_file(folder / "raw/results.json")).contains("flatness"));

    flat.pitch_x = 0.0021;
    surface::write_height_map(folder / "other.tif", flat);
    const auto other = evaluate(folder, "stack.tif", "other", {"--set", "topography.flatness_file=other.tif"});
    EXPECT_EQ(other.exit_code, 2);
    EXPECT_THAT(other.standard_error, HasSubstr("same instrument"));
    // A few gaps are no matter, a missing quarter is.
    flat.pitch_x = 0.002;
    flat.height(3, 3) = flat.height(20, 5) = std::numeric_limits<double>::quiet_NaN();
    surface::write_height_map(folder / "gaps.tif", flat);
    ASSERT_EQ(evaluate(folder, "stack.tif", "gaps", {"--set", "topography.flatness_file=gaps.tif"}).exit_code, 0);
    const auto over_gaps = surface::read_height_map(folder / "gaps/topography.tif");
    if (const double height = raw.height(5, 18); !std::isnan(height)) {
        EXPECT_NEAR(over_gaps.height(5, 18), height - curvature(5, 18), 1e-9);
    }
    for (int row = 0; row < side / 2; ++row)
        for (int column = 0; column < side / 2; ++column)
            flat.height(column, row) = std::numeric_limits<double>::quiet_NaN();
    surface::write_height_map(folder / "quarter.tif", flat);
    const auto quarter = evaluate(folder, "stack.tif", "quarter", {"--set", "topography.flatness_file=quarter.tif"});
    EXPECT_EQ(quarter.exit_code, 2);
    EXPECT_THAT(quarter.standard_error, HasSubstr("75 % of the points"));
    EXPECT_EQ(evaluate(folder, "stack.tif", "none", {"--set", "topography.flatness_file=none.tif"}).exit_code, 2);
    EXPECT_EQ(evaluate(folder, "stack.tif", "empty", {"--set", "topography.flatness_file=none"}).exit_code, 0);
}

// A grey image with an opacity that is nowhere whole.
void write_transparent_png(const std::filesystem::path& path, const std::vector<int>& image) {
    const auto output = OIIO::ImageOutput::create("png");
    OIIO::ImageSpec spec(side, side, 2, OIIO::TypeDesc::UINT8);
    spec.alpha_channel = 1;
    spec.attribute("oiio:UnassociatedAlpha", 1);
    std::vector<std::uint8_t> values;
    for (std::size_t k = 0; k < image.size(); ++k) {
        values.push_back(static_cast<std::uint8_t>(image[k]));
        values.push_back(static_cast<std::uint8_t>(k % 7 * 30));
    }
    ASSERT_TRUE(output->open(path.string(), spec));
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::UINT8, values.data()));
    ASSERT_TRUE(output->close());
}

TEST(Topography, OpacityDoesNotChangeHeights) {
    const auto folder = fresh_folder("opacity");
    const auto stack = stack_values(255);
    write_pages<std::uint8_t>(folder / "stack.tif", stack, 1, OIIO::TypeDesc::UINT8);
    std::filesystem::create_directory(folder / "images");
    for (std::size_t k = 0; k < stack.size(); ++k)
        write_transparent_png(folder / fmt::format("images/{}.png", k), stack[k]);
    for (const char* name : {"stack.tif", "images"}) {
        const auto result = evaluate(folder, name, std::string("of_") + name);
        ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    }
    EXPECT_EQ(read_file(folder / "of_images/topography.tif"), read_file(folder / "of_stack.tif/topography.tif"));
}

TEST(Topography, DoubtsAboutTheHeightsOfImagesAreTold) {
    const auto folder = fresh_folder("doubts");
    const auto stack = stack_values(255);
    std::filesystem::create_directory(folder / "images");
    const auto write = [&](const std::string& name, std::size_t k) {
        write_pages<std::uint8_t>(folder / "images" / name, {stack[k]}, 1, OIIO::TypeDesc::UINT8);
    };
    for (std::size_t k = 0; k < stack.size(); ++k)
        write(fmt::format("z{:+}.tif", static_cast<int>(k) - 5), k);
    const auto whole = evaluate(folder, "images", "whole");
    ASSERT_EQ(whole.exit_code, 0) << whole.standard_error;
    EXPECT_THAT(whole.standard_error, Not(HasSubstr("warning")));
    const auto results = nlohmann::json::parse(read_file(folder / "whole/results.json"));
    EXPECT_EQ(results["first_image"], "z-5.tif");
    EXPECT_EQ(results["last_image"], "z+6.tif");
    EXPECT_EQ(results["images"], images);

    std::filesystem::remove(folder / "images/z+2.tif");
    const auto gap = evaluate(folder, "images", "gap");
    EXPECT_EQ(gap.exit_code, 0);
    EXPECT_THAT(gap.standard_error, HasSubstr("z+3 follows z+1"));
    write("z+2 copy.tif", 7);
    EXPECT_THAT(evaluate(folder, "images", "copy").standard_error, HasSubstr("natural order"));

    write_pages<std::int16_t>(
        folder / "negative.tif",
        [&] {
            auto lower = stack;
            for (auto& image : lower)
                for (int& value : image)
                    value -= 128;
            return lower;
        }(),
        1, OIIO::TypeDesc::INT16);
    EXPECT_THAT(evaluate(folder, "negative.tif", "negative").standard_error, HasSubstr("below zero"));
}

// Nothing of another stack or of a control stays among the results.
TEST(Topography, ResultsAreOfTheLastEvaluationAlone) {
    const auto folder = fresh_folder("last");
    write_pages<std::uint8_t>(folder / "stack.tif", stack_values(255), 1, OIIO::TypeDesc::UINT8);
    ASSERT_EQ(evaluate(folder, "stack.tif", "out", {"--shuffle", "3"}).exit_code, 0);
    write_file(folder / "out/results.json", replaced(read_file(folder / "out/results.json"), "\"shuffle_seed\"",
                                                     "\"device\": \"another\", \"shuffle_seed\""));
    ASSERT_EQ(evaluate(folder, "stack.tif", "out").exit_code, 0);
    const auto results = nlohmann::json::parse(read_file(folder / "out/results.json"));
    EXPECT_FALSE(results.contains("shuffle_seed"));
    EXPECT_FALSE(results.contains("device"));
}

TEST(Topography, WhatIsMissingIsNamed) {
    const auto folder = fresh_folder("missing");
    write_pages<std::uint8_t>(folder / "stack.tif", stack_values(255), 1, OIIO::TypeDesc::UINT8);
    write_pages<std::uint8_t>(folder / "two.tif", {stack_values(255)[0], stack_values(255)[1]}, 1,
                              OIIO::TypeDesc::UINT8);
    std::filesystem::create_directory(folder / "empty");
    const auto refused = [&](std::vector<std::string> arguments, const std::string& words) {
        arguments.insert(arguments.begin(), "--topography");
        const auto result = run_program(arguments, folder);
        EXPECT_EQ(result.exit_code, 2) << words;
        EXPECT_THAT(result.standard_error, HasSubstr(words));
    };
    refused({"stack.tif"}, "--z_step_um");
    refused({"stack.tif", "--z_step_um", "1"}, "no --pitch_um");
    refused({"stack.tif", "--z_step_um", "1", "--pitch_um", "-1", "--out", "out"}, "no --pitch_um");
    refused({"stack.tif", "--z_step_um", "1", "--pitch_um", "nan", "--out", "out"}, "no --pitch_um");
    refused({"stack.tif", "--z_step_um", "inf", "--pitch_um", "1", "--out", "out"}, "no --z_step_um");
    refused({"stack.tif", "--z_step_um", "1", "--pitch_um", "1", "--z_start_um", "nan", "--out", "out"},
            "--z_start_um");
    refused({"stack.tif", "--z_step_um", "1", "--pitch_um", "1"}, "no --out");
    refused({".", "--z_step_um", "1", "--pitch_um", "1", "--out", "../missing"}, "mixed");
    std::filesystem::create_directory(folder / "another");
    write_file(folder / "another/stack.toml", "");
    refused({"stack.tif", "--z_step_um", "1", "--pitch_um", "1", "--out", "another"}, "mixed");
    refused({"empty", "--z_step_um", "1", "--pitch_um", "1", "--out", "out"}, "no stack.toml and no image");
    refused({"two.tif", "--z_step_um", "1", "--pitch_um", "1", "--out", "out"}, "at least 3 images");
    refused({"stack.tif", "--z_step_um", "1", "--pitch_um", "1", "--out", "out", "--set", "topography.peak=top"},
            "centre-of-gravity");
    refused({"stack.tif", "--z_step_um", "1", "--pitch_um", "1", "--out", "out", "--set", "trace.rays=5"}, "trace");
    const auto elsewhere = run_program({"--devices", "--pitch_um", "1"}, folder);
    EXPECT_EQ(elsewhere.exit_code, 2);
    EXPECT_THAT(elsewhere.standard_error, HasSubstr("--topography"));
}

TEST(NaturalOrder, CountsNumbers) {
    using scan::naturally_before;
    EXPECT_TRUE(naturally_before("image_9.tif", "image_10.tif"));
    EXPECT_FALSE(naturally_before("image_10.tif", "image_9.tif"));
    EXPECT_TRUE(naturally_before("a2b10", "a2b11"));
    EXPECT_TRUE(naturally_before("a", "a1"));
    EXPECT_TRUE(naturally_before("a007", "a8"));
    EXPECT_TRUE(naturally_before("9", "99999999999999999999999999999"));
    EXPECT_NE(naturally_before("a01", "a1"), naturally_before("a1", "a01"));
    EXPECT_FALSE(naturally_before("a1", "a1"));
    EXPECT_TRUE(naturally_before("a1z", "b0"));
    // A strict weak order: sorted is sorted, whatever the order before.
    std::vector<std::string> names = {"z1", "z2", "z10", "z10a", "z11", "z100"};
    const auto sorted = names;
    std::mt19937 random(1);
    for (int k = 0; k < 20; ++k) {
        std::ranges::shuffle(names, random);
        std::ranges::sort(names, naturally_before);
        EXPECT_EQ(names, sorted);
    }
}

// Names in the order of their heights, whatever the order that they are given in; doubtful ones say so.
TEST(ImageOrder, IsThatOfTheNumberInWhichNamesDiffer) {
    std::mt19937 random(1);
    const auto ordered = [&](std::vector<std::string> names) {
        std::ranges::shuffle(names, random);
        const auto found = scan::order_of_names(names);
        std::vector<std::string> result;
        for (const std::size_t place : found.order)
            result.push_back(names[place]);
        return std::pair(result, found.doubt.empty());
    };
    using Names = std::vector<std::string>;
    for (const Names& names :
         {Names{"z_0", "z_0.25", "z_0.5", "z_0.75", "z_1"}, Names{"z-1 um", "z-0.5 um", "z0 um", "z+0.5 um"},
          Names{"image-8", "image-9", "image-10"}, Names{"x2_9", "x2_10", "x2_11"}, Names{"-2", "-1", "0", "1"},
          Names{"a08", "a09", "a10"}, Names{"s.001", "s.002", "s.003"}, Names{"z0.333", "z0.667", "z1.000"}})
        for (int k = 0; k < 5; ++k)
            EXPECT_EQ(ordered(names), std::pair(names, true));
    for (const Names& names :
         {Names{"a1", "a2", "a4"}, Names{"a1", "a2", "b3"}, Names{"v1.9", "v1.10", "v1.11"}, Names{"a01", "a1"},
          Names{"t1_z2", "t2_z1"}, Names{"bright", "dark"}, Names{"1", "99999999999999999998", "99999999999999999999"}})
        EXPECT_EQ(ordered(names), std::pair(names, false)) << names.back();
}

} // namespace
} // namespace vkfv::test
