#include "specimen/description.hpp"

#include "core/mathematics/fourier.hpp"
#include "core/mathematics/units.hpp"
#include "specimen/shapes.hpp"
#include "support/surface_files.hpp"
#include "surface_files/surface_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>

using namespace vkfv;
using namespace vkfv::specimen;
using vkfv::test::over;

namespace {

const HeightField& field_of(const Specimen& specimen) {
    return std::get<HeightField>(specimen.geometry);
}

double at(const HeightField& field, double x, double y) {
    return static_cast<double>(field.heights(static_cast<int>(std::lround((x - field.x_min) / field.pitch_x)),
                                             static_cast<int>(std::lround((y - field.y_min) / field.pitch_y))));
}

Plateaus letters(const std::string& text, std::vector<double> heights) {
    auto d = over<Plateaus>(0.4, 0.001);
    d.text = text;
    d.font = "DejaVuSans-Bold";
    d.text_width = 0.32;
    d.heights = std::move(heights);
    return d;
}

TEST(Plateaus, LettersHaveTheirHeightsFromLeftToRight) {
    const Specimen made = make({.shape = letters("vk f", {0.002, 0.004, 0.006})});
    const HeightField& field = field_of(made);
    std::map<float, std::pair<int, int>> columns; // of each height: first and last
    for (int row = 0; row < field.heights.rows; ++row)
        for (int column = 0; column < field.heights.columns; ++column) {
            const float height = field.heights(column, row);
            const auto [entry, first] = columns.try_emplace(height, column, column);
            entry->second = {std::min(entry->second.first, column), std::max(entry->second.second, column)};
        }
    ASSERT_EQ(columns.size(), 4u);
    EXPECT_LT(columns.at(0.002f).second, columns.at(0.004f).first);
    EXPECT_LT(columns.at(0.004f).second, columns.at(0.006f).first);
    // The text is as wide as asked for, and in the middle: widths are whole points, four letters and three gaps.
    EXPECT_NEAR(columns.at(0.006f).second - columns.at(0.002f).first, 320, 12);
    EXPECT_NEAR(columns.at(0.006f).second + columns.at(0.002f).first, 400, 12);
}

TEST(Plateaus, ALetterReadsCorrectlyFromAbove) {
    // An L has its stem at the left and its bar below.
    const Specimen made = make({.shape = letters("L", {0.003})});
    const HeightField& field = field_of(made);
    double left = 0, right = 0, lower = 0, upper = 0;
    for (int row = 0; row < field.heights.rows; ++row)
        for (int column = 0; column < field.heights.columns; ++column)
            if (field.heights(column, row) > 0) {
                (2 * column < field.heights.columns ? left : right) += 1;
                (2 * row < field.heights.rows ? lower : upper) += 1;
            }
    EXPECT_GT(left, 1.5 * right);
    EXPECT_GT(lower, 1.5 * upper);
}

TEST(Plateaus, MaskOfAnImageWithAHeightAGreyValue) {
    auto d = over<Plateaus>(0.2, 0.001);
    d.file = std::filesystem::path(VKFV_SOURCE_DIR) / "assets/specimens/letter_F.png";
    d.heights = {0.005};
    const Specimen made = make({.shape = d});
    const HeightField& field = field_of(made);
    // The values are those of the F of tests/references/make_specimens.py: its stem, the plate right of it, its upper
    // bar.
    EXPECT_FLOAT_EQ(static_cast<float>(at(field, -0.03, -0.03)), 0.005f);
    EXPECT_EQ(at(field, 0.03, -0.03), 0);
    EXPECT_FLOAT_EQ(static_cast<float>(at(field, 0.03, 0.05)), 0.005f);
    d.heights = {0.005, 0.006};
    EXPECT_THROW(make({.shape = d}), InputError);
}

TEST(Plateaus, UnknownFontsAndMissingHeightsAreRefused) {
    auto d = letters("vkfv", {0.001, 0.002});
    EXPECT_THROW(make({.shape = d}), InputError);
    d = letters("vkfv", {0.001});
    d.font = "no such font";
    EXPECT_THROW(make({.shape = d}), InputError);
    d = letters("  ", {0.001});
    EXPECT_THROW(make({.shape = d}), InputError);
}

Air air() {
    auto d = over<Air>(0.4, 0.001);
    d.tiles = 2;
    d.sq = 0.0015;
    d.roll_off = 0.05;
    d.shortest = 0.01;
    d.hurst = 0.8;
    d.seed = 3;
    return d;
}

// The power over rings of frequency (cycles a tile) of one sub-surface.
std::vector<double> rings(const HeightField& field, int tile_column, int points) {
    Grid<std::complex<double>> tile(points, points);
    for (int row = 0; row < points; ++row)
        for (int column = 0; column < points; ++column)
            tile(column, row) = static_cast<double>(field.heights(tile_column * points + column, row));
    fourier_transform(tile);
    std::vector<double> power(static_cast<std::size_t>(points), 0.0), count(power);
    for (int m = 0; m < points; ++m)
        for (int l = 0; l < points; ++l) {
            const double frequency = std::hypot(fourier_frequency(l, points), fourier_frequency(m, points)) * points;
            const auto ring = static_cast<std::size_t>(std::lround(frequency));
            power[ring] += std::norm(tile(l, m));
            count[ring] += 1;
        }
    for (std::size_t k = 0; k < power.size(); ++k)
        power[k] = count[k] > 0 ? power[k] / count[k] : 0;
    return power;
}

TEST(SubSurfaces, HaveThePowerSpectrumThatIsStated) {
    const Specimen made = make({.shape = air()});
    const HeightField& field = field_of(made);
    ASSERT_EQ(field.heights.columns, 401);
    const std::vector<double> power = rings(field, 0, 200);
    // In tiles of 0.2 mm the roll-off is at 4 cycles, the end at 20. Rings hold 2 pi k modes, half of them independent,
    // each exponential: the standard error of a mean over rings a..b is 1 / sqrt(pi (b^2 - a^2) / 2). Ten of these are
    // allowed.
    const auto mean = [&](int a, int b) {
        double sum = 0, count = 0;
        for (int k = a; k <= b; ++k) {
            const double expected = std::pow(std::max(1.0, k / 4.0), -2 * 1.8);
            sum += power[static_cast<std::size_t>(k)] / expected * k;
            count += k;
        }
        return sum / count;
    };
    const double middle = mean(5, 10), upper = mean(11, 18), lower = mean(1, 4);
    EXPECT_NEAR(upper / middle, 1, 5 * (1 / std::sqrt(pi * 75 / 2) + 1 / std::sqrt(pi * 200 / 2)) + 0.05);
    EXPECT_NEAR(lower / middle, 1, 5 * (1 / std::sqrt(pi * 15 / 2) + 1 / std::sqrt(pi * 75 / 2)));
    // The wrong twin: a Hurst exponent 0.5 off changes the ratio of the two by (14.5 / 7.5)^1 = 1.9.
    EXPECT_LT(power[22] / power[18], 1e-6); // nothing beyond the shortest wavelength but the rounding to float
}

TEST(SubSurfaces, HaveTheirSqAndMeetAtSeams) {
    const Specimen made = make({.shape = air()});
    const HeightField& field = field_of(made);
    const auto sq = [&](int tile_column, int tile_row) {
        double sum = 0, square = 0;
        for (int row = 0; row < 200; ++row)
            for (int column = 0; column < 200; ++column) {
                const double z = static_cast<double>(field.heights(tile_column * 200 + column, tile_row * 200 + row));
                sum += z;
                square += z * z;
            }
        EXPECT_NEAR(sum / 40000, 0, 1e-9); // rounding to float of heights of 1e-3 mm: 6e-11 each
        return std::sqrt(square / 40000);
    };
    for (int tile = 0; tile < 4; ++tile)
        EXPECT_NEAR(sq(tile % 2, tile / 2), 0.0015, 1e-8);
    // Across the seam heights are independent (rms difference sqrt(2) Sq); inside, a pitch apart, they nearly agree.
    const auto step = [&](int column) {
        double square = 0;
        for (int row = 0; row < 400; ++row) {
            const double d = static_cast<double>(field.heights(column, row) - field.heights(column - 1, row));
            square += d * d;
        }
        return std::sqrt(square / 400);
    };
    EXPECT_GT(step(200), 0.0012);
    EXPECT_LT(step(100), 0.0004);
}

TEST(SubSurfaces, OfAMeasuredSurfaceRepeatItsMiddle) {
    const auto file = std::filesystem::path(testing::TempDir()) / "vkfv_sub_surfaces.x3p";
    surface::HeightMap map{.height = Grid<double>(61, 51), .x0 = 0, .y0 = 0, .pitch_x = 0.002, .pitch_y = 0.002};
    for (int row = 0; row < 51; ++row)
        for (int column = 0; column < 61; ++column)
            map.height(column, row) =
                0.001 * std::sin(2 * pi * (column - 30) / 20.0) * std::cos(2 * pi * (row - 25) / 25.0);
    map.height(30, 25) = std::numeric_limits<double>::quiet_NaN();
    surface::write_surface(file, map);
    auto d = over<Air>(0.16, 0.001);
    d.tiles = 2;
    d.file = file;
    const Specimen made = make({.shape = d});
    const HeightField& field = field_of(made);
    ASSERT_EQ(field.heights.columns, 161);
    // A tile's middle lies between its points 39 and 40, at the file's point (30, 25). Levelling a wave of whole
    // periods moves little, and cubic convolution errs by (pi / 20)^3 = 0.004 of the amplitude.
    for (const int tile : {0, 80})
        for (const int k : {-10, 7, 15})
            EXPECT_NEAR(field.heights(tile + 40 + k, 40), 0.001 * std::sin(2 * pi * (k + 0.5) / 40.0), 3e-5)
                << tile << k;
    std::size_t gaps = 0;
    for (const bool gap : field.interpolated)
        gaps += gap;
    EXPECT_EQ(gaps, 4u * 4u); // two by two points of each of four tiles
    d.size = 0.3;
    EXPECT_THROW(make({.shape = d}), InputError); // tiles of 0.15 mm of a surface of 0.12 x 0.1 mm
    std::filesystem::remove(file);
}

TEST(SubSurfaces, OtherSeedsMakeOtherSurfaces) {
    Air d = air();
    const Specimen first = make({.shape = d});
    d.seed = 4;
    const Specimen second = make({.shape = d});
    double product = 0;
    for (std::size_t k = 0; k < field_of(first).heights.values.size(); ++k)
        product += static_cast<double>(field_of(first).heights.values[k] * field_of(second).heights.values[k]);
    // A surface has about (0.4 / 0.05)^2 * pi independent patches: the correlation's standard error is below 0.1.
    EXPECT_LT(std::abs(product) / 401 / 401 / (0.0015 * 0.0015), 0.5);
}

TEST(Star, SectorsAlternateAndEndAtTheRadius) {
    auto d = over<Star>(0.2, 0.001);
    d.petals = 8;
    d.radius = 0.08;
    d.height = 0.004;
    const Specimen made = make({.shape = d});
    const HeightField& field = field_of(made);
    for (int half = 0; half < 16; ++half) {
        const double azimuth = (half + 0.5) * pi / 8;
        EXPECT_FLOAT_EQ(static_cast<float>(at(field, 0.06 * std::cos(azimuth), 0.06 * std::sin(azimuth))),
                        half % 2 == 0 ? 0.004f : 0.0f);
        EXPECT_EQ(at(field, 0.09 * std::cos(azimuth), 0.09 * std::sin(azimuth)), 0);
    }
}

TEST(Groove, HasItsWidthAndDepth) {
    auto d = over<Groove>(0.2, 0.001);
    d.width = 0.05;
    d.depth = 0.003;
    d.wall = 0.004;
    const Specimen made = make({.shape = d});
    const HeightField& field = field_of(made);
    EXPECT_FLOAT_EQ(static_cast<float>(at(field, 0.022, 0.05)), -0.003f);
    EXPECT_FLOAT_EQ(static_cast<float>(at(field, -0.025, 0)), -0.0015f); // the middle of the flank
    EXPECT_EQ(at(field, 0.028, 0), 0);
    d.width = 0.3;
    EXPECT_THROW(make({.shape = d}), InputError);
}

} // namespace
