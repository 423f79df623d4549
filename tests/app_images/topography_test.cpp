// --topography evaluates stacks that vkfv did not make.
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
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace vkfv::test {
namespace {

using ::testing::HasSubstr;

constexpr int side = 24, images = 12;

// The texture's contrast is exp(-(k - height)^2 / 4) in image k: it is sharp at 4 on the left and at 7.25 on the right.
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

// A description of the first page, and its number of pixels a unit.
struct Statement {
    std::string description;
    float per_unit = 0;
    std::string unit = "none";
};

template <class Value>
void write_pages(const std::filesystem::path& path, const std::vector<std::vector<int>>& stack, int channels,
                 OIIO::TypeDesc type, const Statement& statement = {}) {
    const auto output = OIIO::ImageOutput::create("tiff");
    OIIO::ImageSpec spec(side, side, channels, type);
    std::vector<OIIO::ImageSpec> specs(stack.size(), spec);
    if (!statement.description.empty()) {
        specs.front().attribute("ImageDescription", statement.description);
    }
    if (statement.per_unit > 0) {
        specs.front().attribute("XResolution", statement.per_unit);
        specs.front().attribute("YResolution", statement.per_unit);
        specs.front().attribute("ResolutionUnit", statement.unit);
    }
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

// A flat of the same instrument takes the curvature off by its polynomial; a flat of another grid is not of the same
// instrument.
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
    // Columns and rows count from 0 to 23. Levelled, the parabola is left: 11.5^2 - 0.5^2 times 1e-3 um, of which the
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

// Writes a grey image with an opacity that is nowhere whole.
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
    EXPECT_THAT(gap.standard_error, HasSubstr("an image is missing between z+1.tif and z+3.tif"));
    write("z+2 copy.tif", 7);
    EXPECT_THAT(evaluate(folder, "images", "copy").standard_error, HasSubstr("z+2 copy.tif is left out"));
    for (const char* name : {"z-5.tif", "z-4.tif", "z-2.tif"}) {
        std::filesystem::rename(folder / "images" / name, folder / "images" / (std::string("new ") + name));
    }
    EXPECT_THAT(evaluate(folder, "images", "renamed").standard_error, HasSubstr("natural order"));
    for (int k = 0; k < 8; ++k) {
        write(fmt::format("aligned_{}.tif", k), 7);
    }
    const auto several = evaluate(folder, "images", "several");
    EXPECT_EQ(several.exit_code, 2);
    EXPECT_THAT(several.standard_error, HasSubstr("several series of images: those of aligned_0.tif and of z"));
    for (int k = 0; k < 8; ++k) {
        std::filesystem::remove(folder / "images" / fmt::format("aligned_{}.tif", k));
    }
    for (const char* name : {"new z-5.tif", "new z-4.tif", "new z-2.tif", "z+2 copy.tif", "z+5.tif", "z-1.tif"}) {
        std::filesystem::remove(folder / "images" / name);
    }
    EXPECT_THAT(evaluate(folder, "images", "uneven").standard_error, HasSubstr("z+1 follows z+0"));

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

// The statements of a file are used where no option says otherwise, and its channels are no heights (cases/20).
TEST(Topography, WhatAFileStatesIsUsed) {
    const auto folder = fresh_folder("stated");
    const auto stack = stack_values(255);
    write_pages<std::uint8_t>(folder / "alone.tif", stack, 1, OIIO::TypeDesc::UINT8);
    std::vector<std::vector<int>> two; // channels: noise, and the stack
    std::mt19937 random(7);
    for (const auto& image : stack) {
        auto& noise = two.emplace_back(image);
        std::ranges::generate(noise, [&] { return static_cast<int>(20 + random() % 10); });
        two.push_back(image);
    }
    write_pages<std::uint8_t>(
        folder / "two.tif", two, 1, OIIO::TypeDesc::UINT8,
        {"ImageJ=1.53t\nimages=24\nchannels=2\nslices=12\nhyperstack=true\nunit=um\nspacing=0.5\n", 5000, "cm"});
    const std::vector<std::string> few = {"--set", "topography.window_px=3", "--set", "topography.smoothing_steps=0"};
    const auto run = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "--topography");
        arguments.insert(arguments.end(), few.begin(), few.end());
        return run_program(arguments, folder);
    };
    ASSERT_EQ(evaluate(folder, "alone.tif", "alone").exit_code, 0);
    const auto chosen = run({"two.tif", "--channel", "2", "--out", "chosen"});
    ASSERT_EQ(chosen.exit_code, 0) << chosen.standard_error;
    EXPECT_THAT(chosen.standard_error, HasSubstr("--z_step_um 0.5 is taken from the file (ImageJ's description)"));
    EXPECT_THAT(chosen.standard_error, HasSubstr("--pitch_um 2 is taken from the file"));
    EXPECT_EQ(read_file(folder / "chosen/topography.tif"), read_file(folder / "alone/topography.tif"));
    const auto not_chosen = run({"two.tif", "--out", "refused"});
    EXPECT_EQ(not_chosen.exit_code, 2);
    EXPECT_THAT(not_chosen.standard_error, HasSubstr("pages: 24, heights: 12, channels: 2, frames: 1"));
    EXPECT_THAT(not_chosen.standard_error, HasSubstr("--channel 1 to 2"));
    EXPECT_EQ(run({"two.tif", "--channel", "3", "--out", "refused"}).exit_code, 2);
    EXPECT_EQ(run({"two.tif", "--channel", "2", "--frame", "2", "--out", "refused"}).exit_code, 2);
    // Where option and file differ by less than 1 % nothing is said; beyond, both are told and the option counts.
    const auto near = run({"two.tif", "--channel", "2", "--z_step_um", "0.503", "--out", "near"});
    EXPECT_THAT(near.standard_error, testing::Not(HasSubstr("but the file states")));
    const auto other = run({"two.tif", "--channel", "2", "--z_step_um", "1", "--pitch_um", "2.1", "--out", "other"});
    ASSERT_EQ(other.exit_code, 0) << other.standard_error;
    EXPECT_THAT(other.standard_error, HasSubstr("--z_step_um 1, but the file states 0.5 (ImageJ's description)"));
    EXPECT_THAT(other.standard_error, HasSubstr("--pitch_um 2.1, but the file states 2 "));
    EXPECT_EQ(nlohmann::json::parse(read_file(folder / "other/results.json"))["z_step_um"], 1.0);
    // OME-XML orders the same pages otherwise.
    std::vector<std::vector<int>> parted;
    for (std::size_t k = 0; k < two.size(); ++k) {
        parted.push_back(two[k < stack.size() ? 2 * k : 2 * (k - stack.size()) + 1]);
    }
    write_pages<std::uint8_t>(folder / "parted.tif", parted, 1, OIIO::TypeDesc::UINT8,
                              {"<?xml version=\"1.0\"?><OME><Image ID=\"Image:0\">"
                               "<AcquisitionDate>2024-02-29T01:02:03</AcquisitionDate><Pixels DimensionOrder=\"XYZCT\" "
                               "SizeX=\"24\" SizeY=\"24\" SizeZ=\"12\" SizeC=\"2\" SizeT=\"1\" Type=\"uint8\" "
                               "PhysicalSizeX=\"2\" PhysicalSizeY=\"2\" PhysicalSizeZ=\"500\" "
                               "PhysicalSizeZUnit=\"nm\"/></Image></OME>"});
    const auto ome = run({"parted.tif", "--channel", "2", "--out", "ome"});
    ASSERT_EQ(ome.exit_code, 0) << ome.standard_error;
    EXPECT_EQ(read_file(folder / "ome/topography.tif"), read_file(folder / "alone/topography.tif"));
    // X3P, which has a date in any case, has that of the images.
    ASSERT_EQ(run_program({"surface", "ome/topography.x3p", "--out", "dated.csv"}, folder).exit_code, 0);
    EXPECT_THAT(read_file(folder / "dated.csv"), HasSubstr("date=2024-02-29T01:02:03Z"));
    // The scan starts where the planes stand; a start that differs by less than a hundredth of a step is no other
    // start.
    std::string planes;
    for (std::size_t k = 0; k < stack.size(); ++k) {
        planes += fmt::format("<Plane TheZ=\"{}\" TheC=\"0\" TheT=\"0\" PositionZ=\"{}\" PositionZUnit=\"um\"/>", k,
                              3 + 0.5 * static_cast<double>(k));
    }
    write_pages<std::uint8_t>(folder / "placed.tif", stack, 1, OIIO::TypeDesc::UINT8,
                              {"<?xml version=\"1.0\"?><OME><Image ID=\"Image:0\"><Pixels DimensionOrder=\"XYZCT\" "
                               "SizeX=\"24\" SizeY=\"24\" SizeZ=\"12\" SizeC=\"1\" SizeT=\"1\" Type=\"uint8\" "
                               "PhysicalSizeX=\"2\" PhysicalSizeY=\"2\">" +
                               planes + "</Pixels></Image></OME>"});
    for (const auto& [start, is_other] : {std::pair{"", false}, {"3.004", false}, {"4", true}}) {
        SCOPED_TRACE(start);
        std::vector<std::string> arguments = {"placed.tif", "--out", "placed"};
        if (*start != '\0') {
            arguments.insert(arguments.end(), {"--z_start_um", start});
        }
        const auto placed = run(arguments);
        ASSERT_EQ(placed.exit_code, 0) << placed.standard_error;
        const auto told = HasSubstr("--z_start_um 4, but the file states 3");
        EXPECT_EQ(testing::Value(placed.standard_error, told), is_other) << placed.standard_error;
        const auto results = nlohmann::json::parse(read_file(folder / "placed/results.json"));
        EXPECT_EQ(results["z_start_um"], *start == '\0' ? 3 : std::stod(start));
        std::filesystem::remove_all(folder / "placed");
    }
    // An option gives the step alone: the file's start stands.
    ASSERT_EQ(run({"placed.tif", "--z_step_um", "0.5", "--out", "placed"}).exit_code, 0);
    EXPECT_EQ(nlohmann::json::parse(read_file(folder / "placed/results.json"))["z_start_um"], 3);
    // Resolution tags state the pitch, unless they are those of a printer.
    write_pages<std::uint8_t>(folder / "tags.tif", stack, 1, OIIO::TypeDesc::UINT8, {"", 5000, "cm"});
    const auto tags = run({"tags.tif", "--z_step_um", "0.5", "--out", "tags"});
    ASSERT_EQ(tags.exit_code, 0) << tags.standard_error;
    EXPECT_EQ(read_file(folder / "tags/topography.tif"), read_file(folder / "alone/topography.tif"));
    write_pages<std::uint8_t>(folder / "print.tif", stack, 1, OIIO::TypeDesc::UINT8, {"", 300, "in"});
    const auto print = run({"print.tif", "--z_step_um", "0.5", "--out", "print"});
    EXPECT_EQ(print.exit_code, 2);
    EXPECT_THAT(print.standard_error, HasSubstr("as for a printer"));
}

// A file that is no image of the series is left out by name, and images that are missing leave their heights
// (cases/22).
TEST(Topography, AFolderMayHoldMoreAndLessThanTheSeries) {
    const auto folder = fresh_folder("series");
    const auto stack = stack_values(255);
    const auto write = [&](const std::string& name, const std::vector<int>& image) {
        std::filesystem::create_directories((folder / name).parent_path());
        write_pages<std::uint8_t>(folder / name, {image}, 1, OIIO::TypeDesc::UINT8);
    };
    for (std::size_t k = 0; k < stack.size(); ++k) {
        write(fmt::format("whole/img_{:03}.tif", k), stack[k]);
        write(fmt::format("more/img_{:03}.tif", k), stack[k]);
        if (k != 10) {
            write(fmt::format("less/img_{:03}.tif", k), stack[k]);
        }
        write(fmt::format("named/z{:+.1f}um.tif", 0.5 * static_cast<double>(k) - 2), stack[k]);
    }
    write("more/output.tif", stack[3]);
    write("more/depth_1.tif", stack[5]);
    write_file(folder / "more/img_101.tif", ""); // a copy that was interrupted
    const auto small = OIIO::ImageOutput::create("tiff");
    ASSERT_TRUE(small->open((folder / "more/img_100.tif").string(), OIIO::ImageSpec(8, 8, 1, OIIO::TypeDesc::UINT8)));
    ASSERT_TRUE(small->write_image(OIIO::TypeDesc::UINT8, std::vector<std::uint8_t>(64).data()));
    ASSERT_TRUE(small->close());
    ASSERT_EQ(evaluate(folder, "whole", "of_whole").exit_code, 0);
    const auto more = evaluate(folder, "more", "of_more");
    ASSERT_EQ(more.exit_code, 0) << more.standard_error;
    for (const char* name :
         {"output.tif is left out", "depth_1.tif is left out", "img_100.tif is left out: it has another size",
          "img_101.tif is left out: it cannot be read"}) {
        EXPECT_THAT(more.standard_error, HasSubstr(name));
    }
    EXPECT_EQ(read_file(folder / "of_more/topography.tif"), read_file(folder / "of_whole/topography.tif"));
    const auto less = evaluate(folder, "less", "of_less");
    ASSERT_EQ(less.exit_code, 0) << less.standard_error;
    EXPECT_THAT(less.standard_error, HasSubstr("an image is missing between img_009.tif and img_011.tif"));
    const auto whole = surface::read_height_map(folder / "of_whole/topography.tif");
    const auto without = surface::read_height_map(folder / "of_less/topography.tif");
    for (const int column : {5, 18}) { // far from what is missing
        EXPECT_NEAR(without.height(column, 9), whole.height(column, 9), 5e-6);
    }
    const auto named = run_program({"--topography", "named", "--pitch_um", "2", "--out", "of_named", "--set",
                                    "topography.window_px=3", "--set", "topography.smoothing_steps=0"},
                                   folder);
    ASSERT_EQ(named.exit_code, 0) << named.standard_error;
    EXPECT_THAT(named.standard_error, HasSubstr("--z_step_um 0.5 is taken from the file (the names of the files)"));
    EXPECT_NEAR(surface::read_height_map(folder / "of_named/topography.tif").height(5, 9), whole.height(5, 9) - 2e-3,
                1e-8);
}

// The camera has an offset of its own in each pixel, light that falls off, pixels that are always lit and one that
// never is.
TEST(Topography, DarkAndFlatFieldAreTakenOff) {
    const auto folder = fresh_folder("corrected");
    const auto stack = stack_values(20000);
    std::mt19937 random(11);
    std::vector<int> offset(side * side);
    std::vector<double> gain(side * side);
    for (std::size_t p = 0; p < offset.size(); ++p) {
        offset[p] = 300 + static_cast<int>(random() % 20);
        const double x = static_cast<double>(p % side) / side - 0.5, y = static_cast<double>(p) / (side * side) - 0.5;
        gain[p] = 2 * (1 - x * x - y * y) * (p % 5 == 0 ? 0.9 : 1);
    }
    const std::vector<std::size_t> lit = {5 * side + 6, 9 * side + 19}, unlit = {18 * side + 4};
    const auto seen = [&](auto light) {
        std::vector<int> image(side * side);
        for (std::size_t p = 0; p < image.size(); ++p) {
            image[p] = static_cast<int>(std::lround(light(p) * gain[p])) + offset[p];
        }
        for (const std::size_t p : lit) {
            image[p] = 65000;
        }
        for (const std::size_t p : unlit) {
            image[p] = offset[p];
        }
        return image;
    };
    std::vector<std::vector<int>> by_camera;
    for (const auto& image : stack) {
        by_camera.push_back(seen([&](std::size_t p) { return image[p]; }));
    }
    write_pages<std::uint16_t>(folder / "ideal.tif", stack, 1, OIIO::TypeDesc::UINT16);
    write_pages<std::uint16_t>(folder / "stack.tif", by_camera, 1, OIIO::TypeDesc::UINT16);
    const auto dark = seen([](std::size_t) { return 0; });
    write_pages<std::uint16_t>(folder / "dark.tif", {dark, dark}, 1, OIIO::TypeDesc::UINT16);
    write_pages<std::uint16_t>(folder / "flat.tif", {seen([](std::size_t) { return 15000; })}, 1,
                               OIIO::TypeDesc::UINT16);
    ASSERT_EQ(evaluate(folder, "ideal.tif", "ideal").exit_code, 0);
    const auto result = evaluate(folder, "stack.tif", "out", {"--dark", "dark.tif", "--flat-field", "flat.tif"});
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    ASSERT_EQ(evaluate(folder, "stack.tif", "raw").exit_code, 0);
    const auto results = nlohmann::json::parse(read_file(folder / "out/results.json"));
    EXPECT_EQ(results["dead_pixels"], 3);
    EXPECT_EQ(results["dark"], "dark.tif");
    EXPECT_EQ(results["flat_field"], "flat.tif");
    const auto ideal = surface::read_height_map(folder / "ideal/topography.tif");
    const auto map = surface::read_height_map(folder / "out/topography.tif");
    const auto raw = surface::read_height_map(folder / "raw/topography.tif");
    double worst = 0, worst_raw = 0;
    for (int row = 2; row < side - 2; ++row) {
        for (int column = 2; column < side - 2; ++column) {
            const auto place = static_cast<std::size_t>((side - 1 - row) * side + column);
            const bool by_dead = std::ranges::any_of(std::array{lit[0], lit[1], unlit[0]}, [&](std::size_t dead) {
                const auto apart = [](std::size_t a, std::size_t b) { return a > b ? a - b : b - a; };
                return apart(dead / side, place / side) <= 2 && apart(dead % side, place % side) <= 2;
            });
            if (!by_dead && std::isfinite(ideal.height(column, row)) && std::isfinite(map.height(column, row))) {
                worst = std::max(worst, std::abs(map.height(column, row) - ideal.height(column, row)));
                if (std::isfinite(raw.height(column, row))) {
                    worst_raw = std::max(worst_raw, std::abs(raw.height(column, row) - ideal.height(column, row)));
                }
            }
        }
    }
    constexpr double rounding = 5e-6; // mm, of values to whole numbers
    EXPECT_LT(worst, rounding);
    EXPECT_GT(worst_raw, rounding); // wrong twin: nothing taken off
    // Images that are taken off must exist, have the stack's size, and be dark or lit as their option says.
    write_file(folder / "small.pgm", "P5\n2 2\n255\n\1\2\1\2");
    for (const auto& [option, file, words] : std::vector<std::array<std::string, 3>>{
             {"--dark", "small.pgm", "24 x 24 pixels"}, {"--flat-field", "none.tif", "no such file"}}) {
        const auto refused = evaluate(folder, "stack.tif", "refused", {option, file});
        EXPECT_EQ(refused.exit_code, 2) << option;
        EXPECT_THAT(refused.standard_error, HasSubstr(words));
    }
    const auto unlit_flat =
        evaluate(folder, "stack.tif", "refused", {"--dark", "dark.tif", "--flat-field", "dark.tif"});
    EXPECT_EQ(unlit_flat.exit_code, 2);
    EXPECT_THAT(unlit_flat.standard_error, HasSubstr("more light"));
}

// Exposures that jump between two images and saturated pixels are reported as faults of the images. The wrong twin, the
// stack without either, gives no warning.
TEST(Topography, FaultsOfTheImagesAreTold) {
    const auto folder = fresh_folder("faults");
    auto stack = stack_values(40000);
    write_pages<std::uint16_t>(folder / "good.tif", stack, 1, OIIO::TypeDesc::UINT16);
    for (std::size_t k = 0; k < stack.size(); ++k) {
        for (int& value : stack[k]) {
            value = k < 7 ? value : static_cast<int>(std::lround(1.25 * value)); // longer exposed
        }
        std::fill_n(stack[k].begin(), 2 * side, 65535); // a highlight
    }
    write_pages<std::uint16_t>(folder / "stack.tif", stack, 1, OIIO::TypeDesc::UINT16);
    const auto good = evaluate(folder, "good.tif", "good");
    ASSERT_EQ(good.exit_code, 0) << good.standard_error;
    EXPECT_THAT(good.standard_error, Not(HasSubstr("warning")));
    const auto result = evaluate(folder, "stack.tif", "out");
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    EXPECT_THAT(result.standard_error, HasSubstr(" % at image 7 and stays so"));
    EXPECT_THAT(result.standard_error, HasSubstr("8.3 % of the pixels are saturated"));
    const auto faults = nlohmann::json::parse(read_file(folder / "out/results.json"))["image_faults"];
    EXPECT_NEAR(faults["saturated_share"], 2.0 / side, 1e-12);
    EXPECT_GT(faults["exposure_step"], 0.1);
    EXPECT_LT(faults["flicker"], 0.01);
    // Images in random order have no step to tell of.
    const auto shuffled = evaluate(folder, "stack.tif", "shuffled", {"--shuffle", "1"});
    EXPECT_THAT(shuffled.standard_error, Not(HasSubstr("stays so")));
}

// A stack.toml that claims more pixels, or more images, than there are is refused before any work is sized by it.
TEST(Topography, WorkIsSizedByTheImages) {
    const auto folder = fresh_folder("claimed");
    std::filesystem::copy(std::filesystem::path(VKFV_SOURCE_DIR) / "tests/data/stacks_1.0.0/finished", folder / "stack",
                          std::filesystem::copy_options::recursive);
    const auto file = folder / "stack/stack.toml";
    const std::string claims = read_file(file);
    const auto refused = [&](const std::string& from, const std::string& to, const std::string& words) {
        ASSERT_THAT(claims, HasSubstr(from));
        write_file(file, replaced(claims, from, to));
        const auto began = std::chrono::steady_clock::now();
        const auto result = run_program({"--topography", "stack", "--out", "out"}, folder);
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_THAT(result.standard_error, HasSubstr(words));
        EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count(), 20); // 90 s before
    };
    refused("\npixels = 32\n", "\npixels = 16000\n", "16000 x 16000, as stack.toml claims");
    refused("\nz_stop_um = 12.5\n", "\nz_stop_um = 5000\n", "as stack.toml claims");
    // Options for images alone are refused beside a stack.toml, not passed over.
    write_file(file, claims);
    for (const char* option : {"--dark", "--flat-field"}) {
        const auto beside = run_program({"--topography", "stack", "--out", "out", option, "none.tif"}, folder);
        EXPECT_EQ(beside.exit_code, 2) << option;
        EXPECT_THAT(beside.standard_error, HasSubstr("stack.toml"));
    }
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
    // The order is a strict weak one: sorted names are sorted, whatever the order before.
    std::vector<std::string> names = {"z1", "z2", "z10", "z10a", "z11", "z100"};
    const auto sorted = names;
    std::mt19937 random(1);
    for (int k = 0; k < 20; ++k) {
        std::ranges::shuffle(names, random);
        std::ranges::sort(names, naturally_before);
        EXPECT_EQ(names, sorted);
    }
}

// Names are put in the order of their heights, whatever the order that they are given in; doubtful ones say so.
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

// Four of five steps are equal and the others whole multiples: heights follow the numbers.
TEST(ImageOrder, LeavesRoomForImagesThatAreMissing) {
    const auto found = scan::order_of_names({"i_3", "i_5", "i_7", "i_13", "i_9", "i_15", "i_17"});
    EXPECT_TRUE(found.doubt.empty());
    EXPECT_THAT(found.heights, testing::ElementsAre(0, 1, 2, 3, 5, 6, 7));
    EXPECT_FALSE(found.step);
    const auto uneven = scan::order_of_names({"i_1", "i_2", "i_3", "i_4", "i_5", "i_6.5"});
    EXPECT_THAT(uneven.doubt, HasSubstr("i_6.5 follows i_5"));
    EXPECT_THAT(uneven.heights, testing::ElementsAre(0, 1, 2, 3, 4, 5));
    // A camera's counter begins again after 9999: not thousands of images are missing.
    const auto again = scan::order_of_names(
        {"DSC_9995", "DSC_9996", "DSC_9997", "DSC_9998", "DSC_9999", "DSC_0001", "DSC_0002", "DSC_0003"});
    EXPECT_THAT(again.doubt, HasSubstr("DSC_9995 follows DSC_0003"));
    EXPECT_THAT(again.heights, testing::ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
}

TEST(ImageOrder, ReadsTheUnitBehindTheNumber) {
    for (const auto& [unit, length] : std::vector<std::pair<std::string, double>>{{"um", 1e-3},
                                                                                  {" um", 1e-3},
                                                                                  {"_um", 1e-3},
                                                                                  {"\u00b5m", 1e-3},
                                                                                  {"nm", 1e-6},
                                                                                  {"mm", 1},
                                                                                  {"umbra", 0},
                                                                                  {"", 0}}) {
        const auto found = scan::order_of_names({"z-30.0" + unit, "z-27.5" + unit, "z-25.0" + unit, "z+10.0" + unit,
                                                 "z12.5" + unit, "z15.0" + unit, "z17.5" + unit, "z20.0" + unit});
        EXPECT_EQ(found.step.has_value(), length > 0) << unit;
        if (length > 0) {
            EXPECT_NEAR(*found.step, 2.5 * length, 1e-12);
            EXPECT_NEAR(*found.first, -30 * length, 1e-12);
        }
    }
}

// Names as programs write them: the value of a height may be negative in all of them, stand beside a count, or have a
// decimal comma. Where a hyphen separates, the number has no sign.
TEST(ImageOrder, ReadsHeightsHoweverNamesStateThem) {
    struct Case {
        std::vector<std::string> names;
        double first, step; // um
    };
    for (const Case& one : std::vector<Case>{
             {{"z=-30.0um", "z=-28.0um", "z=-26.0um", "z=-24.0um"}, -30, 2},
             {{"z-30.0um", "z-28.0um", "z-26.0um", "z-24.0um"}, -30, 2},
             {{"img-z-30um", "img-z-28um", "img-z-26um"}, 26, 2},
             {{"z(-3)_um", "z(-2)_um", "z(-1)_um"}, 0, 0}, // the bracket stands between number and unit
             {{"img_001_z-8.0um", "img_002_z-6.0um", "img_003_z-4.0um"}, -8, 2},
             {{"img_001_z8nm", "img_002_z6nm", "img_003_z4nm"}, 4e-3, 2e-3},
             {{"z2,5um", "z3,0um", "z3,5um"}, 2.5, 0.5},
             {{"z=-2,5 um", "z=-2,0 um", "z=-1,5 um"}, -2.5, 0.5},
             {{"z\u22123um", "z\u22122um", "z\u22121um", "z0um"}, -3, 1},
             {{"5microns", "6microns", "7microns"}, 5, 1},
         }) {
        const auto found = scan::order_of_names(one.names);
        EXPECT_EQ(found.doubt, "") << one.names.front();
        EXPECT_NEAR(found.first.value_or(0), one.first * 1e-3, 1e-12) << one.names.front();
        EXPECT_NEAR(found.step.value_or(0), one.step * 1e-3, 1e-12) << one.names.front();
    }
    // Numbers of pixels with a unit behind two of them do not say which is the height.
    EXPECT_NE(scan::order_of_names({"x1um_z3um", "x2um_z2um", "x3um_z1um"}).doubt, "");
    // A sign does not turn counts round.
    EXPECT_THAT(scan::order_of_names({"img-003", "img-001", "img-002"}).order, testing::ElementsAre(1, 2, 0));
    EXPECT_THAT(scan::order_of_names({"k=-3", "k=-1", "k=-2"}).order, testing::ElementsAre(0, 2, 1));
    EXPECT_EQ(scan::order_of_names({"1,9", "1,10", "1,11"}).doubt, ""); // a comma alone only separates
}

TEST(ImageOrder, TellsSeriesApartByANumber) {
    std::vector<std::string> scans, three, tiles, heights, midnight;
    for (int k = 0; k < 5; ++k) {
        for (int series = 1; series <= 2; ++series) {
            scans.push_back(fmt::format("scan{}_{:03}", series, k));
            heights.push_back(fmt::format("s{}_z{}um", series, k));
        }
        for (int series = 1; series <= 5; ++series) {
            three.push_back(fmt::format("{}-{:02}-a{}", series % 3, k, 7));
            tiles.push_back(fmt::format("x{}_y{}", series, k));
        }
        midnight.push_back(fmt::format("IMG_{}_{}", k < 3 ? 20240101 : 20240102, k < 3 ? 235957 + k : k - 3));
    }
    EXPECT_THAT(scan::several_series(scans), testing::ElementsAre(0, 1));
    EXPECT_THAT(scan::several_series(heights), testing::ElementsAre(0, 1));
    EXPECT_THAT(scan::several_series(three), testing::SizeIs(3));
    EXPECT_THAT(scan::several_series(tiles), testing::SizeIs(5));
    EXPECT_THAT(scan::several_series(midnight), testing::IsEmpty());
    EXPECT_THAT(scan::several_series({"i1_z2um", "i2_z4um", "i3_z6um", "i4_z8um"}), testing::IsEmpty());
}

TEST(ImageOrder, TellsAResultFromASeries) {
    const auto kept = scan::of_one_series({"pcb_1", "output", "pcb_2", "pcb_3", "pcb_4", "pcb_10"});
    EXPECT_THAT(kept, testing::ElementsAre(true, false, true, true, true, true));
    EXPECT_THAT(scan::of_one_series({"z-1", "z+2", "z3"}), testing::Each(true));
    EXPECT_THAT(scan::of_one_series({"a1", "b1", "a2", "b2", "a3"}), testing::Each(true)); // no series
    EXPECT_THAT(scan::of_one_series({"a1_1", "a2_2", "a3_1", "a4_2", "out"}), testing::Each(true));
    // focus-stack leaves aligned copies and its result beside the photographs.
    EXPECT_THAT(scan::several_series({"aligned_1", "pcb_1", "aligned_2", "pcb_2", "pcb_3", "aligned_3", "output"}),
                testing::ElementsAre(0, 1));
    EXPECT_THAT(scan::several_series({"a1", "b1", "a2", "b2", "a3"}), testing::IsEmpty());
    EXPECT_THAT(scan::several_series({"a1", "a2", "a3", "a4", "b1", "c1", "d1"}), testing::IsEmpty());
}

} // namespace
} // namespace vkfv::test
