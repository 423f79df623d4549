// vkfv surface, through the real program, finds the parameters that closed forms give.
#include "app/program.hpp"
#include "core/mathematics/units.hpp"
#include "images/image_file.hpp"
#include "support/surface_files.hpp"
#include "surface_files/surface_file.hpp"

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace vkfv::test {
namespace {

using surface::HeightMap;
using testing::HasSubstr;
using Json = nlohmann::json;

constexpr double um = 1e-3; // mm
constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

// A map of ten whole periods of a wave of 0.5 um along x upon a tilt and an offset. The wave is 12 points long and even
// about the middle, which makes it orthogonal to the tilt; points are 1 x 2 um apart.
HeightMap wavy() {
    HeightMap map{.height = Grid<double>(120, 50), .x0 = 10 * um, .y0 = -20 * um, .pitch_x = 1 * um, .pitch_y = 2 * um};
    for (int row = 0; row < map.rows(); ++row) {
        for (int column = 0; column < map.columns(); ++column) {
            map.height(column, row) =
                (3 + 0.01 * column - 0.02 * row + 0.5 * std::cos(2 * pi * (column - 59.5) / 12)) * um;
        }
    }
    return map;
}

class Surface : public testing::Test {
  protected:
    void SetUp() override {
        folder = fresh_folder("surface");
        surface::write_surface(folder / "wavy.x3p", wavy(), {.model = "M1", .comment = "as measured"});
    }
    Json report(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "--surface");
        arguments.emplace_back("--json");
        const auto result = run_program(arguments, folder);
        EXPECT_EQ(result.exit_code, 0) << result.standard_error;
        return Json::parse(result.standard_output);
    }
    void refused(std::vector<std::string> arguments, const std::vector<std::string>& words) {
        arguments.insert(arguments.begin(), "--surface");
        const auto result = run_program(arguments, folder);
        EXPECT_EQ(result.exit_code, 2) << arguments.at(1);
        EXPECT_EQ(result.standard_output, "");
        for (const auto& word : words) {
            EXPECT_THAT(result.standard_error, HasSubstr(word));
        }
    }
    std::filesystem::path folder;
};

TEST_F(Surface, ReportsTheParametersOfASine) {
    const auto figures = report({"wavy.x3p"});
    EXPECT_EQ(figures["columns"], 120);
    EXPECT_EQ(figures["rows"], 50);
    EXPECT_NEAR(figures["pitch_um"][1], 2, 1e-12);
    EXPECT_EQ(figures["not_measured_points"], 0);
    EXPECT_EQ(figures["treatment"]["form"], "plane");
    // A sampled sine has Sq = A / sqrt 2, and its outermost points lie 15 degrees beside the extremes. Files of metres
    // round to 1e-16 of 3 um.
    const auto& parameters = figures["parameters"];
    EXPECT_NEAR(parameters["Sq_um"], 0.5 / std::sqrt(2), 1e-9);
    EXPECT_NEAR(parameters["Sku"], 1.5, 1e-9);
    EXPECT_NEAR(parameters["Sz_um"], std::cos(15 * radians_per_degree), 1e-9);
    EXPECT_NEAR(parameters["Std_deg"], 90, 1e-9); // the lay runs along y
    // The closed form is that of compare_test: sections of 23.8 um, at which the Gaussian leaves 0.935 of the
    // amplitude.
    EXPECT_NEAR(figures["profile"]["Ra_um"], 2 / pi * 0.5 * 0.935, 0.02);
    // The wrong twin: the tilt of 1.2 and 1 um over the surface is left.
    EXPECT_GT(report({"wavy.x3p", "--form", "none"})["parameters"]["Sq_um"], 0.5);
}

TEST_F(Surface, TakesTheProfileWhereItIsAskedFor) {
    // Along y there is no wave.
    const auto along_y = report({"wavy.x3p", "--profile", "40.5,-20,40.5,78"});
    EXPECT_NEAR(along_y["profile"]["Rq_um"], 0, 1e-9);
    EXPECT_NEAR(along_y["profile"]["section_length_um"], 98 / 5.0, 1e-9);
    EXPECT_EQ(along_y["parameters"], report({"wavy.x3p"})["parameters"]);
    // The profile along the middle row is the default's.
    const auto row = report({"wavy.x3p", "--profile", "10,30,129,30"});
    EXPECT_NEAR(row["profile"]["Rz_um"], report({"wavy.x3p"})["profile"]["Rz_um"], 1e-9);
    EXPECT_GT(row["profile"]["Rq_um"], 0.3);
}

TEST_F(Surface, FiltersAsTold) {
    // Half of the amplitude passes at the nesting index. Within one index of either end, a fifth of the surface, the
    // window lacks up to half of its weight, which changes what passes by up to as much.
    const double half = 0.25 / std::sqrt(2);
    EXPECT_NEAR(report({"wavy.x3p", "--s_filter_um", "12"})["parameters"]["Sq_um"], half, 0.2 * half);
    EXPECT_NEAR(report({"wavy.x3p", "--l-filter-um", "12"})["parameters"]["Sq_um"], half, 0.2 * half);
    // At half the nesting index the spline passes 1 / (1 + 2^4) of the wave, the Gaussian 2^-4.
    const auto spline = report({"wavy.x3p", "--s_filter_um", "24", "--filter", "spline"});
    EXPECT_NEAR(spline["parameters"]["Sq_um"], 2 * half / 17, 0.5 * 2 * half / 17); // natural ends follow more
    EXPECT_EQ(spline["treatment"],
              Json({{"form", "plane"}, {"s_filter_um", 24}, {"l_filter_um", 0}, {"filter", "spline"}}));
    EXPECT_NE(spline["parameters"]["Sq_um"], report({"wavy.x3p", "--s_filter_um", "24"})["parameters"]["Sq_um"]);
}

TEST_F(Surface, CountsTheGapsAndSaysSoInWords) {
    HeightMap map = wavy();
    std::fill_n(map.height.values.begin(), 60, not_measured);
    surface::write_surface(folder / "gaps.sdf", map);
    EXPECT_EQ(report({"gaps.sdf"})["not_measured_points"], 60);
    const auto result = run_program({"--surface", "gaps.sdf", "--form", "polynomial-2", "--l_filter_um", "40"}, folder);
    EXPECT_EQ(result.exit_code, 0) << result.standard_error;
    for (const char* words : {"120 x 50 points, 120 x 100 um", "60 points (1 %)",
                              "form polynomial-2, L-filter 40 um (Gaussian)", "ISO 25178-2", "Vvv", "Rz"}) {
        EXPECT_THAT(result.standard_output, HasSubstr(words));
    }
}

TEST_F(Surface, ConvertsFromFormatToFormat) {
    HeightMap original = wavy();
    const double largest = *std::ranges::max_element(original.height.values);
    original.height(7, 8) = not_measured;
    surface::write_surface(folder / "a.x3p", original, {.model = "M1", .comment = "as measured"});
    const std::vector<std::string> chain = {"a.x3p", "b.sur", "c.sdf", "d.tif", "e.x3p"};
    for (std::size_t k = 0; k + 1 < chain.size(); ++k) {
        report({chain[k], "--form", "none", "--out", chain[k + 1]});
    }
    const HeightMap last = surface::read_surface(folder / "e.x3p").map;
    ASSERT_EQ(last.columns(), original.columns());
    ASSERT_EQ(last.rows(), original.rows());
    EXPECT_NEAR(last.pitch_y, original.pitch_y, 1e-7 * original.pitch_y); // float32 in SUR
    // SUR steps by 2^-29 of the largest height, TIFF rounds by 2^-24 of each height.
    for (std::size_t k = 0; k < original.height.values.size(); ++k) {
        ASSERT_EQ(std::isnan(last.height.values[k]), std::isnan(original.height.values[k]));
        if (!std::isnan(original.height.values[k])) {
            ASSERT_NEAR(last.height.values[k], original.height.values[k], 6.2e-8 * largest);
        }
    }
    report({"wavy.x3p", "--s_filter_um", "12", "--out", "smooth.tif"});
    const auto smooth = surface::read_surface(folder / "smooth.tif");
    EXPECT_EQ(smooth.provenance.model, "M1");
    EXPECT_THAT(smooth.provenance.comment, HasSubstr("as measured"));
    EXPECT_THAT(smooth.provenance.comment, HasSubstr("wavy.x3p, form plane, S-filter 12 um (Gaussian)"));
    EXPECT_EQ(smooth.map.x0, wavy().x0);
    EXPECT_NEAR(report({"smooth.tif", "--form", "none"})["parameters"]["Sq_um"],
                report({"wavy.x3p", "--s_filter_um", "12"})["parameters"]["Sq_um"], 1e-6);
    EXPECT_EQ(run_program({"--surface", "wavy.x3p", "--out", "mesh.ply"}, folder).exit_code, 0);
    EXPECT_THAT(read_file(folder / "mesh.ply"), testing::StartsWith("ply"));
}

TEST_F(Surface, GivesImagesTheirScale) {
    Grid<float> image(30, 20);
    for (std::size_t k = 0; k < image.values.size(); ++k) {
        image.values[k] = k % 2 == 0 ? 5.f : 7.f; // columns, since their number is even
    }
    surface::write_tiff(folder / "plain.tif", image);
    const auto figures = report({"plain.tif", "--pitch_um", "3", "--unit-um", "0.25", "--form", "none"});
    EXPECT_NEAR(figures["pitch_um"][0], 3, 1e-12);
    EXPECT_NEAR(figures["parameters"]["Sq_um"], 0.25, 1e-9);
    refused({"plain.tif"}, {"plain.tif", "--pitch_um = not given", "Give the pitch"});
    refused({"plain.tif", "--pitch_um", "3"}, {"--unit_um = not given", "Give the unit"});
    refused({"plain.tif", "--pitch_um", "-3", "--unit_um", "1"}, {"--pitch_um = -3", "positive"});
    refused({"wavy.x3p", "--pitch_um", "3"}, {"wavy.x3p", "--pitch_um = given", "Leave it out"});
}

TEST_F(Surface, RefusesWhatItCannotDo) {
    const auto original = read_file(folder / "wavy.x3p");
    refused({"wavy.x3p", "--out", "./wavy.x3p"}, {"--out = ./wavy.x3p", "Name a new one"});
    EXPECT_EQ(read_file(folder / "wavy.x3p"), original);
    refused({"wavy.x3p", "--out", "picture.png"},
            {"picture.png", ".x3p, .sur, .sdf, .gwy, .gsf, .npy, .csv, .tif or .ply"});
    refused({"wavy.x3p", "--profile", "0,0,500,0"},
            {"--profile = 0,0,500,0", "x from 10 to 129 um, y from -20 to 78 um"});
    refused({"wavy.x3p", "--profile", "20,0,20,0"}, {"longer than a pitch"});
    refused({"nowhere.x3p"}, {"nowhere.x3p"});
    HeightMap map = wavy();
    for (int row = 0; row < map.rows(); ++row) {
        for (int column = 0; column < map.columns(); ++column) {
            map.height(column, row) = column * um;
        }
    }
    surface::write_surface(folder / "plane.x3p", map);
    refused({"plane.x3p", "--form", "sphere"}, {"--form = sphere", "--form plane"});
    std::ranges::fill(map.height.values, not_measured);
    surface::write_surface(folder / "empty.x3p", map);
    refused({"empty.x3p"}, {"empty.x3p", "no measured point"});
}

TEST_F(Surface, OfOneRowHasWhatOneRowHas) {
    HeightMap row = wavy();
    row.height.rows = 1;
    row.height.values.resize(120);
    surface::write_surface(folder / "row.sdf", row);
    // The row's own line is fitted as its form, and takes the tilt off.
    EXPECT_NEAR(report({"row.sdf"})["parameters"]["Sq_um"], 0.5 / std::sqrt(2), 1e-9);
    HeightMap column = row;
    std::swap(column.height.columns, column.height.rows);
    surface::write_surface(folder / "column.sdf", column);
    EXPECT_TRUE(report({"column.sdf"})["profile"]["Ra_um"].is_null());
}

// float32 would leave nothing of waves of a nanometre on an offset of 25 mm.
TEST_F(Surface, DoublesOfAnImageKeepTheirDigits) {
    const auto output = OIIO::ImageOutput::create("tiff");
    ASSERT_TRUE(output->open((folder / "doubles.tif").string(), OIIO::ImageSpec(120, 4, 1, OIIO::TypeDesc::DOUBLE)));
    std::vector<double> heights; // um
    for (int k = 0; k < 480; ++k) {
        heights.push_back(25000 + 1e-3 * std::cos(2 * pi * (k % 120 - 59.5) / 12));
    }
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::DOUBLE, heights.data()));
    ASSERT_TRUE(output->close());
    const auto figures = report({"doubles.tif", "--pitch_um", "1", "--unit_um", "1"});
    // Rounding 25000 um to double leaves 4e-12 um.
    EXPECT_NEAR(figures["parameters"]["Sq_um"].get<double>(), 1e-3 / std::sqrt(2.0), 1e-9);
}

} // namespace
} // namespace vkfv::test
