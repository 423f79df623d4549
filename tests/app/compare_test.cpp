// vkfv compare, through the real program, finds the deviation of maps that differ by known waves, shifts and noise.
#include "app/program.hpp"
#include "images/image_file.hpp"
#include "support/surface_files.hpp"
#include "surface/filter.hpp"
#include "surface/height_parameters.hpp"
#include "surface/polynomial.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <random>

namespace vkfv::test {
namespace {

using surface::HeightMap;
using testing::HasSubstr;
using Json = nlohmann::json;

constexpr double um = 1e-3; // mm

// Two crossed waves of 0.5 um, 12 and 17 um long: a map of `size` x `size` points, `pitch` um apart from `start` um,
// whose waves lie `shift` um further along x; with an offset, normal noise, and a corner of 5 x 5 points not measured.
void write_map(const std::filesystem::path& file, int size, double start, double pitch, double shift, double noise,
               unsigned seed) {
    HeightMap map{.height = Grid<double>(size, size),
                  .x0 = start * um,
                  .y0 = start * um,
                  .pitch_x = pitch * um,
                  .pitch_y = pitch * um};
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    for (int row = 0; row < size; ++row) {
        for (int column = 0; column < size; ++column) {
            const double x = start + column * pitch - shift, y = start + row * pitch;
            map.height(column, row) =
                (3 + 0.5 * std::sin(2 * M_PI * x / 12) + 0.5 * std::sin(2 * M_PI * y / 17) + noise * normal(random)) *
                um;
            if (noise > 0 && column < 5 && row < 5) {
                map.height(column, row) = std::nan("");
            }
        }
    }
    surface::write_height_map(file, map);
}

class Compare : public testing::Test {
  protected:
    void SetUp() override {
        folder = fresh_folder("compare");
        write_map(folder / "truth.tif", 261, -5, 0.5, 0, 0, 0); // finer than the measurements, and larger
        for (int k = 0; k < 4; ++k) {
            write_map(folder / ("measured_" + std::to_string(k) + ".tif"), 120, 0, 1, 0.4, 0.03,
                      static_cast<unsigned>(k) + 1);
        }
    }
    Json report(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "--compare");
        arguments.emplace_back("--json");
        const auto result = run_program(arguments, folder);
        EXPECT_EQ(result.exit_code, 0) << result.standard_error;
        return Json::parse(result.standard_output);
    }
    std::filesystem::path folder;
};

TEST_F(Compare, ReportsAShiftAndRemovesItOnRequestOnly) {
    const auto as_is = report({"measured_0.tif", "truth.tif"});
    EXPECT_NEAR(as_is["measured"][0]["lateral_shift"]["x_um"], 0.4, 0.02);
    EXPECT_NEAR(as_is["measured"][0]["lateral_shift"]["y_um"], 0, 0.02);
    // A wave moved by d deviates by 2 A sin(pi d / wavelength) / sqrt(2): 0.074 um, with noise of 0.03 um 0.080 um.
    EXPECT_NEAR(as_is["rms_deviation_um"], 0.080, 0.002);
    const auto aligned = report({"measured_0.tif", "truth.tif", "--align"});
    EXPECT_NEAR(aligned["removed_shift_um"][0], 0.4, 0.02);
    // The truth's mean over 1 um lowers its waves by (2 pi / wavelength)^2 m / 2, m = 0.115 and 0.125 um^2 the mean
    // square of its weights' places: 1.6 % and 0.9 %, of 0.35 um each, beside the noise, whose
    // standard deviation over 14 375 points errs by 0.0002 um: five of these.
    EXPECT_NEAR(aligned["rms_deviation_um"], std::hypot(0.03, 0.0056, 0.0030), 0.001);
    // Two sinusoids have an Sq of 0.5 um, except for the mean over 1 um and for parts of periods.
    EXPECT_NEAR(aligned["parameters"]["Sq_um"]["true"], 0.5, 0.02);
    EXPECT_NEAR(aligned["parameters"]["Sq_um"]["measured"], 0.5, 0.02);
    EXPECT_TRUE(aligned["parameters"]["Sq_um"]["standard_error"].is_null());
    // 25 of 14 400 points are not measured.
    EXPECT_NEAR(aligned["measured_share"], 1 - 25 / 14400.0, 1e-9);
}

TEST_F(Compare, TellsSystematicFromRandomOverRepetitions) {
    const auto together = report({"measured_0.tif", "measured_1.tif", "measured_2.tif", "measured_3.tif", "truth.tif"});
    // Each of 14 400 points has three degrees of freedom.
    EXPECT_NEAR(together["random_um"], 0.03, 5 * 0.03 / std::sqrt(2 * 3 * 14400.0));
    EXPECT_NEAR(together["systematic_um"], 0.074, 0.002);
    EXPECT_GT(together["parameters"]["Sa_um"]["standard_error"], 0);
    EXPECT_LT(together["parameters"]["Sa_um"]["standard_error"], 0.002);
}

TEST_F(Compare, WritesMapsAndTables) {
    const auto result = run_program({"--compare", "measured_0.tif", "truth.tif", "--out", "out"}, folder);
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    EXPECT_THAT(result.standard_output, HasSubstr("lateral shift"));
    EXPECT_THAT(result.standard_output, HasSubstr("Vvv"));
    const HeightMap deviation = surface::read_height_map(folder / "out/deviation.tif");
    EXPECT_EQ(deviation.columns(), 120);
    EXPECT_TRUE(std::isnan(deviation.height(2, 2)));
    EXPECT_FALSE(std::isnan(deviation.height(50, 50)));
    EXPECT_THAT(read_file(folder / "out/transfer.csv"), HasSubstr("frequency_per_mm,wavelength_um,transfer,"));
    EXPECT_THAT(read_file(folder / "out/slope.csv"), HasSubstr("slope_from_deg,slope_to_deg,points,measured_share,"));
    EXPECT_NEAR(Json::parse(read_file(folder / "out/compare.json"))["rms_deviation_um"], 0.080, 0.002);
    // Along a row only the wave of 12 um is seen, 0.989 of it after the mean over 1 um; sections are 23.8 um long, at
    // which the Gaussian leaves 1 - 2^-(23.8/12)^2 = 0.935 of its amplitude. Ra is 2 / pi of that, 0.294 um. The window
    // is cut off over a quarter of the profile at either end, which lets up to 0.1 of the amplitude through there.
    const auto profile = Json::parse(read_file(folder / "out/compare.json"))["profile"];
    EXPECT_NEAR(profile["true"]["Ra_um"], 2 / M_PI * 0.5 * 0.989 * 0.935, 0.02);
    EXPECT_GT(profile["measured"]["Rq_um"], profile["true"]["Rq_um"]); // it has noise
}

// The measured heights are 0.8 of the true ones plus 0.2 um, which the regression must tell, without a form that would
// take the offset off.
TEST_F(Compare, TellsSlopeAndOffsetOfMeasuredOnTrueHeights) {
    HeightMap map = surface::read_height_map(folder / "truth.tif");
    for (double& z : map.height.values) {
        z = 0.8 * z + 0.2 * um;
    }
    surface::write_height_map(folder / "scaled.tif", map);
    const auto figures = report({"scaled.tif", "truth.tif", "--form", "none"});
    // The files hold single precision.
    EXPECT_NEAR(figures["regression_slope"], 0.8, 1e-5);
    EXPECT_NEAR(figures["regression_offset_um"], 0.2, 1e-5);
    const auto text = run_program({"--compare", "scaled.tif", "truth.tif"}, folder).standard_output;
    EXPECT_THAT(text, HasSubstr("slope 0.8"));
}

// A flat has no Sq, no other height and no slope: nothing can be divided by them.
TEST_F(Compare, AgainstAFlatTellsNoRatio) {
    HeightMap flat = surface::read_height_map(folder / "truth.tif");
    for (double& z : flat.height.values) {
        z = 0;
    }
    surface::write_height_map(folder / "flat.tif", flat);
    const auto result = run_program({"--compare", "measured_0.tif", "flat.tif"}, folder);
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    EXPECT_THAT(result.standard_output, testing::Not(HasSubstr("inf")));
    EXPECT_THAT(result.standard_output, testing::Not(HasSubstr("nan")));
    EXPECT_TRUE(report({"measured_0.tif", "flat.tif"})["regression_slope"].is_null());
}

TEST_F(Compare, IsOfTheSurfacesAsTreated) {
    write_map(folder / "same_grid.tif", 120, 0, 1, 0, 0, 0);
    const auto plain = report({"measured_0.tif", "same_grid.tif"});
    const auto treated = report({"measured_0.tif", "same_grid.tif", "--form", "polynomial-3", "--s_filter_um", "6",
                                 "--l-filter-um", "30", "--out", "treated"});
    EXPECT_EQ(plain["treatment"],
              Json({{"form", "plane"}, {"s_filter_um", 0}, {"l_filter_um", 0}, {"filter", "gaussian"}}));
    EXPECT_EQ(treated["treatment"],
              Json({{"form", "polynomial-3"}, {"s_filter_um", 6}, {"l_filter_um", 30}, {"filter", "gaussian"}}));

    HeightMap truth = surface::read_height_map(folder / "same_grid.tif");
    const HeightMap measured = surface::read_height_map(folder / "measured_0.tif");
    for (std::size_t k = 0; k < truth.height.values.size(); ++k) {
        if (std::isnan(measured.height.values[k])) {
            truth.height.values[k] = std::nan("");
        }
    }
    const auto by_hand = [](const HeightMap& map) {
        const auto level = surface::remove_polynomial(map, surface::least_squares_polynomial(map, 3));
        return surface::remove_long_waves(surface::gaussian_low_pass(level, 6 * um), 30 * um);
    };
    const auto a = by_hand(measured), b = by_hand(truth);
    const auto& sq = treated["parameters"]["Sq_um"];
    EXPECT_NEAR(sq["measured"], surface::height_parameters(a).sq / um, 1e-9);
    EXPECT_NEAR(sq["true"], surface::height_parameters(b).sq / um, 1e-9);
    EXPECT_GT(std::abs(sq["true"].get<double>() - plain["parameters"]["Sq_um"]["true"].get<double>()), 0.05);
    HeightMap difference = a;
    for (std::size_t k = 0; k < difference.height.values.size(); ++k) {
        difference.height.values[k] -= b.height.values[k];
    }
    difference = surface::remove_plane(difference, surface::least_squares_plane(difference));
    EXPECT_NEAR(treated["rms_deviation_um"], surface::height_parameters(difference).sq / um, 1e-9);
    const HeightMap written = surface::read_height_map(folder / "treated/deviation.tif");
    EXPECT_NEAR(written.height(60, 60), difference.height(60, 60), 1e-9);
    // The profile along the middle row is that of the smoothed truth, and no filter changes the shift.
    EXPECT_LT(treated["profile"]["true"]["Rq_um"], plain["profile"]["true"]["Rq_um"]);
    EXPECT_EQ(treated["measured"][0]["lateral_shift"], plain["measured"][0]["lateral_shift"]);
    const auto text = run_program(
        {"--compare", "measured_0.tif", "same_grid.tif", "--s_filter_um", "6", "--filter", "spline"}, folder);
    EXPECT_THAT(text.standard_output, HasSubstr("form plane, S-filter 6 um (spline)"));
}

TEST_F(Compare, WarnsOfAFileWithoutAPlace) {
    write_map(folder / "same.tif", 120, 7, 1, 0, 0, 0);
    const auto moved = run_program({"--compare", "measured_0.tif", "same.tif"}, folder);
    EXPECT_EQ(moved.exit_code, 0);
    EXPECT_THAT(moved.standard_error, HasSubstr("begin at different places"));
    const auto other = run_program({"--compare", "measured_0.tif", "truth.tif"}, folder);
    EXPECT_THAT(other.standard_error, testing::Not(HasSubstr("places")));
}

TEST_F(Compare, RefusesWhatCannotBeCompared) {
    write_map(folder / "other.tif", 100, 0, 1, 0, 0, 0);
    const auto grids = run_program({"--compare", "measured_0.tif", "other.tif", "truth.tif"}, folder);
    EXPECT_EQ(grids.exit_code, 2);
    EXPECT_THAT(grids.standard_error, HasSubstr("other.tif: vkfv compare = 100 x 100 points"));

    HeightMap elsewhere = surface::read_height_map(folder / "truth.tif");
    elsewhere.x0 += 1;
    surface::write_height_map(folder / "elsewhere.tif", elsewhere);
    const auto apart = run_program({"--compare", "measured_0.tif", "elsewhere.tif"}, folder);
    EXPECT_EQ(apart.exit_code, 2);
    EXPECT_THAT(apart.standard_error, HasSubstr("heights where measured_0.tif has them"));

    HeightMap flat = surface::read_height_map(folder / "other.tif");
    std::ranges::fill(flat.height.values, 1 * um);
    surface::write_height_map(folder / "flat.tif", flat);
    const auto sphere = run_program({"--compare", "flat.tif", "truth.tif", "--form", "sphere"}, folder);
    EXPECT_EQ(sphere.exit_code, 2);
    EXPECT_THAT(sphere.standard_error, HasSubstr("--form plane"));

    EXPECT_EQ(run_program({"--compare", "measured_0.tif"}, folder).exit_code, 2);
    EXPECT_EQ(run_program({"--compare", "measured_0.tif", "nowhere.tif"}, folder).exit_code, 2);
}

} // namespace
} // namespace vkfv::test
