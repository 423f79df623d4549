#include "topography/lateral_shift.hpp"

#include "topography/waves.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

namespace vkfv::topography {
namespace {

using namespace test;
using surface::HeightMap;

constexpr double pitch = 0.002;

double all(double) {
    return 1;
}

// A map of waves of 6 to 40 pitches, with tilt, noise of a tenth of Sq, and a tenth of the points not measured.
HeightMap rough(double shift_x, double shift_y, unsigned seed) {
    auto map = map_of(random_waves(60, 1 / (40 * pitch), 1 / (6 * pitch), 1e-3, 1), 150, 120, pitch, shift_x * pitch,
                      shift_y * pitch, all);
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0, 5e-4);
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column) {
            map.height(column, row) += 0.3 + 0.05 * map.x(column) - 0.02 * map.y(row) + normal(random);
            if (random() % 10 == 0)
                map.height(column, row) = std::numeric_limits<double>::quiet_NaN();
        }
    return map;
}

TEST(LateralShift, IsFoundToAFiftiethOfAPitch) {
    const HeightMap truth =
        map_of(random_waves(60, 1 / (40 * pitch), 1 / (6 * pitch), 1e-3, 1), 150, 120, pitch, 0, 0, all);
    // Noise of 5e-4 mm over a slope of about 5.5e-3 / 1.6 mm a pitch and 14 000 points leaves 1e-3 of a pitch; the
    // cubic convolution's phase at six pitches a wave is wrong by less than 0.01 of a pitch.
    for (const auto& [x, y] : {std::pair(0.0, 0.0), std::pair(0.37, -0.21), std::pair(-12.63, 7.5)}) {
        const LateralShift shift = lateral_shift(rough(x, y, 2), truth);
        EXPECT_NEAR(shift.x / pitch, x, 0.02);
        EXPECT_NEAR(shift.y / pitch, y, 0.02);
        EXPECT_GT(shift.correlation, 0.98);
        // The wrong twin has the other sign.
        if (x != 0) {
            EXPECT_GT(std::abs(shift.x / pitch + x), 0.5);
        }
    }
}

TEST(LateralShift, MovesTheTruthUnderTheMeasurement) {
    const HeightMap truth =
        map_of(random_waves(60, 1 / (40 * pitch), 1 / (6 * pitch), 1e-3, 1), 150, 120, pitch, 0, 0, all);
    const HeightMap measured = map_of(random_waves(60, 1 / (40 * pitch), 1 / (6 * pitch), 1e-3, 1), 150, 120, pitch,
                                      0.37 * pitch, -0.21 * pitch, all);
    const HeightMap moved = shifted_onto(truth, measured, lateral_shift(measured, truth));
    double squares = 0, points = 0;
    for (std::size_t k = 0; k < moved.height.values.size(); ++k)
        if (const double d = measured.height.values[k] - moved.height.values[k]; !std::isnan(d)) {
            squares += d * d;
            points += 1;
        }
    // Sq is 5.5e-3 mm; at six pitches a wave cubic convolution keeps it but for some per cent.
    EXPECT_LT(std::sqrt(squares / points), 3e-4);
    EXPECT_GT(points, 17000);
}

TEST(LateralShift, IsFoundOnAFinerTruth) {
    const auto waves = random_waves(60, 1 / (40 * pitch), 1 / (6 * pitch), 1e-3, 1);
    // The truth has three points a pitch, from a pitch before to beyond the measurement.
    HeightMap truth = map_of(waves, 456, 366, pitch / 3, pitch, pitch, all);
    truth.x0 -= pitch;
    truth.y0 -= pitch;
    const LateralShift shift = lateral_shift(rough(0.37, -0.21, 4), truth);
    EXPECT_NEAR(shift.x / pitch, 0.37, 0.01);
    EXPECT_NEAR(shift.y / pitch, -0.21, 0.01);
}

TEST(LateralShift, OfAGrooveIsKnownAcrossItOnly) {
    const auto groove = [](double shift) {
        return map_of({{1e-3, 1 / (11 * pitch), 0, 0}}, 130, 40, pitch, shift * pitch, 0, all);
    };
    const LateralShift shift = lateral_shift(groove(1.3), groove(0));
    EXPECT_NEAR(shift.x / pitch, 1.3, 0.02);
    EXPECT_NEAR(shift.y / pitch, 0, 1e-6);
}

TEST(LateralShift, IsUndefinedWhereNothingVaries) {
    const HeightMap flat = map_of({}, 30, 30, pitch, 0, 0, all);
    EXPECT_TRUE(std::isnan(lateral_shift(flat, flat).x));
    HeightMap elsewhere = rough(0, 0, 2);
    elsewhere.x0 += 1;
    EXPECT_TRUE(std::isnan(lateral_shift(rough(0, 0, 2), elsewhere).x));
}

// White noise through a Gaussian of standard deviation `sigma`, points apart, to Sq 1; larger than the maps
// cut from it.
Grid<double> smooth_noise(int columns, int rows, double sigma, unsigned seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    const int radius = static_cast<int>(3.5 * sigma);
    Grid<double> noise(columns + 2 * radius, rows + 2 * radius);
    for (double& value : noise.values)
        value = normal(random);
    std::vector<double> weights;
    for (int k = -radius; k <= radius; ++k)
        weights.push_back(std::exp(-k * k / (2 * sigma * sigma)) / std::sqrt(sigma * std::sqrt(pi)));
    Grid<double> along_x(columns, noise.rows), both(columns, rows);
    for (int row = 0; row < noise.rows; ++row)
        for (int column = 0; column < columns; ++column)
            for (int k = 0; k <= 2 * radius; ++k)
                along_x(column, row) += weights[static_cast<std::size_t>(k)] * noise(column + k, row);
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            for (int k = 0; k <= 2 * radius; ++k)
                both(column, row) += weights[static_cast<std::size_t>(k)] * along_x(column, row + k);
    return both;
}

struct Pair {
    HeightMap measured, truth;
};

// Two maps of one surface, `shift_x` and `shift_y` points apart, 20 at most; the measured one has noise of `noise`, and
// of either the share `gaps` of the points is left out.
Pair moved_pair(int points, double sigma, int shift_x, int shift_y, double noise, double gaps, unsigned seed) {
    const Grid<double> surface = smooth_noise(points + 40, points + 40, sigma, seed);
    std::mt19937_64 random(seed + 1000);
    std::normal_distribution<double> normal(0, noise);
    std::uniform_real_distribution<double> share;
    const HeightMap empty{
        .height = Grid<double>(points, points), .x0 = 0, .y0 = 0, .pitch_x = pitch, .pitch_y = 1.7 * pitch};
    Pair pair{.measured = empty, .truth = empty};
    for (int row = 0; row < points; ++row)
        for (int column = 0; column < points; ++column) {
            pair.truth.height(column, row) = 1e-3 * surface(column + 20, row + 20);
            pair.measured.height(column, row) =
                1e-3 * (surface(column + 20 - shift_x, row + 20 - shift_y) + normal(random));
        }
    for (HeightMap* map : {&pair.measured, &pair.truth})
        for (double& z : map->height.values)
            if (share(random) < gaps)
                z = std::numeric_limits<double>::quiet_NaN();
    return pair;
}

TEST(LateralShift, OfNothingIsFound) {
    // The sign of the shift decides whether the border belongs to the overlap.
    for (unsigned seed = 0; seed < 12; ++seed) {
        const Pair pair = moved_pair(100, 6, 0, 0, 0.02, 0, seed);
        const LateralShift shift = lateral_shift(pair.measured, pair.truth);
        // Noise of 0.02 over a slope of 1 / (6 sqrt(2)) a point and 10^4 points leaves 0.002 of a pitch; five of these
        // are allowed.
        EXPECT_NEAR(shift.x / pitch, 0, 0.01) << seed;
        EXPECT_NEAR(shift.y / pitch / 1.7, 0, 0.01) << seed;
        EXPECT_GT(shift.correlation, 0.999) << seed;
    }
}

TEST(LateralShift, OfSmoothSurfacesIsFound) {
    // Hardly more than one hill is in sight: the overlap's mean and its variance change with the lag.
    struct Case {
        int points;
        double sigma;
        int x, y;
        double gaps;
    };
    for (const Case& c : {Case{100, 15, -4, 4, 0}, Case{100, 10, 4, 3, 0}, Case{200, 15, 4, -4, 0},
                          Case{100, 5, -17, 12, 0}, Case{100, 10, 5, 2, 0.02}, Case{100, 15, 0, 0, 0.02}})
        for (unsigned seed = 0; seed < 6; ++seed) {
            const Pair pair = moved_pair(c.points, c.sigma, c.x, c.y, 0.02, c.gaps, seed);
            const LateralShift shift = lateral_shift(pair.measured, pair.truth);
            // Noise of 0.02 over a slope of 1 / (15 sqrt(2)) a point and 6000 points leaves 0.006 of a pitch; offset
            // and tilt take some of it.
            EXPECT_NEAR(shift.x / pitch, c.x, 0.05) << c.points << ' ' << c.sigma << ' ' << seed;
            EXPECT_NEAR(shift.y / pitch / 1.7, c.y, 0.05) << c.points << ' ' << c.sigma << ' ' << seed;
        }
}

TEST(LateralShift, OfUnrelatedSurfacesIsNotFound) {
    int found = 0;
    for (const double sigma : {0.8, 3.0, 8.0})
        for (unsigned seed = 0; seed < 8; ++seed) {
            const Pair one = moved_pair(60, sigma, 0, 0, 0.02, 0, seed),
                       other = moved_pair(60, sigma, 0, 0, 0.02, 0, seed + 100);
            found += !std::isnan(lateral_shift(one.measured, other.truth).x);
        }
    EXPECT_EQ(found, 0);
    // Levelled planes leave rounding alone, which has no shift.
    Pair planes = moved_pair(60, 3, 0, 0, 0.02, 0, 1);
    for (int row = 0; row < 60; ++row)
        for (int column = 0; column < 60; ++column) {
            planes.measured.height(column, row) = 0.3 + 0.5 * planes.measured.x(column);
            planes.truth.height(column, row) = 0.1 - 0.2 * planes.truth.y(row);
        }
    EXPECT_TRUE(std::isnan(lateral_shift(planes.measured, planes.truth).x));
}

TEST(LateralShift, OfATiltedObliqueGrooveIsAcrossIt) {
    const auto groove = [](double shift_x, double shift_y) {
        HeightMap map =
            map_of({{1e-3, 0.08 / pitch, 0.03 / pitch, 0.4}}, 130, 70, pitch, shift_x * pitch, shift_y * pitch, all);
        std::mt19937_64 random(5);
        std::normal_distribution<double> normal(0, 1e-5);
        for (int row = 0; row < map.rows(); ++row)
            for (int column = 0; column < map.columns(); ++column)
                map.height(column, row) += 0.1 * map.y(row) + (shift_x != 0 ? normal(random) : 0.0);
        return map;
    };
    const LateralShift shift = lateral_shift(groove(1.6, 0.6), groove(0, 0));
    EXPECT_NEAR(shift.x / pitch, 1.6, 0.02);
    EXPECT_NEAR(shift.y / pitch, 0.6, 0.02);
}

TEST(LateralShift, OfAProfileIsAlongIt) {
    const std::vector<Wave> waves = {{1e-3, 0.05 / pitch, 0, 0.4}, {1e-3, 0.013 / pitch, 0, 1}};
    const LateralShift shift =
        lateral_shift(map_of(waves, 200, 1, pitch, 3.3 * pitch, 0, all), map_of(waves, 200, 1, pitch, 0, 0, all));
    EXPECT_NEAR(shift.x / pitch, 3.3, 0.02);
    EXPECT_EQ(shift.y, 0);
}

} // namespace
} // namespace vkfv::topography
