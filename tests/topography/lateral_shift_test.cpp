#include "topography/lateral_shift.hpp"

#include "topography/waves.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vkfv::topography {
namespace {

using namespace test;
using surface::HeightMap;

constexpr double pitch = 0.002;

double all(double) { return 1; }

// Wavelengths of 6 to 40 pitches; with tilt, noise of a tenth of Sq, and a tenth of the points not measured.
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
    const HeightMap truth = map_of(random_waves(60, 1 / (40 * pitch), 1 / (6 * pitch), 1e-3, 1), 150, 120, pitch, 0, 0,
                                   all);
    // Noise of 5e-4 mm over a slope of about 5.5e-3 / 1.6 mm a pitch and 14 000 points leaves 1e-3 of a pitch; the
    // cubic convolution's phase at six pitches a wave is wrong by less than 0.01 of a pitch.
    for (const auto& [x, y] : {std::pair(0.0, 0.0), std::pair(0.37, -0.21), std::pair(-12.63, 7.5)}) {
        const LateralShift shift = lateral_shift(rough(x, y, 2), truth);
        EXPECT_NEAR(shift.x / pitch, x, 0.02);
        EXPECT_NEAR(shift.y / pitch, y, 0.02);
        EXPECT_GT(shift.correlation, 0.98);
        // The wrong twin, the other sign.
        if (x != 0) {
            EXPECT_GT(std::abs(shift.x / pitch + x), 0.5);
        }
    }
}

TEST(LateralShift, MovesTheTruthUnderTheMeasurement) {
    const HeightMap truth = map_of(random_waves(60, 1 / (40 * pitch), 1 / (6 * pitch), 1e-3, 1), 150, 120, pitch, 0, 0,
                                   all);
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
    // Three points a pitch, from a pitch before to beyond the measurement.
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

} // namespace
} // namespace vkfv::topography
