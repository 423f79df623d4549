// Patterns of reflectance agree with closed forms and with other ways to write them.
#include "physics/physics.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <random>
#include <vector>

using namespace vkfv::physics;

namespace {

constexpr double two_pi = 6.283185307179586;

// A map over a grid of its own, in either precision.
struct Map {
    f64::Pattern record{.lowest = 0,
                        .highest = 1,
                        .centre_x = 0,
                        .centre_y = 0,
                        .axis_x = 1,
                        .axis_y = 0,
                        .per_mm = 1,
                        .cycles = 1,
                        .columns = 0,
                        .rows = 0,
                        .square = 0,
                        .of_light = 0,
                        .kind = f64::PATTERN_GRATING};
    std::vector<double> values{};

    double pattern_point(const f64::Pattern&, int column, int row) const {
        return values[static_cast<std::size_t>(row * record.columns + column)];
    }
    double operator()(double x, double y) const { return f64::pattern_factor(*this, record, x, y); }
    void turn(double angle) {
        record.axis_x = std::cos(angle);
        record.axis_y = std::sin(angle);
    }
};

struct FloatMap {
    const Map* map;
    float pattern_point(const f32::Pattern&, int column, int row) const {
        return static_cast<float>(map->pattern_point(map->record, column, row));
    }
    float operator()(float x, float y) const {
        const auto& r = map->record;
        const f32::Pattern record{static_cast<float>(r.lowest),
                                  static_cast<float>(r.highest),
                                  static_cast<float>(r.centre_x),
                                  static_cast<float>(r.centre_y),
                                  static_cast<float>(r.axis_x),
                                  static_cast<float>(r.axis_y),
                                  static_cast<float>(r.per_mm),
                                  r.cycles,
                                  r.columns,
                                  r.rows,
                                  r.square,
                                  r.of_light,
                                  r.kind};
        return f32::pattern_factor(*this, record, x, y);
    }
};

struct Point {
    double x, y;
};
std::vector<Point> points(int count, double reach) {
    std::mt19937_64 generator(7);
    const auto uniform = [&] { return reach * (2 * (static_cast<double>(generator() >> 11) + 0.5) * 0x1p-53 - 1); };
    std::vector<Point> result;
    for (int k = 0; k < count; ++k) {
        const double x = uniform();
        result.push_back({x, uniform()});
    }
    return result;
}

// The mean of the map times exp(-2 pi i (fx x + fy y)) over a square of the side 1 mm.
std::complex<double> coefficient(const Map& map, double fx, double fy) {
    constexpr int side = 400;
    std::complex<double> sum = 0;
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            const double x = (column + 0.5) / side - 0.5, y = (row + 0.5) / side - 0.5;
            sum += map(x, y) * std::polar(1.0, -two_pi * (fx * x + fy * y));
        }
    }
    return sum / double(side * side);
}

} // namespace

// The grating has 5 periods a mm along (3, 4) / 5: the phase at the origin says where it is brightest.
TEST(Reflectance, ASinusoidalGratingIsOneFrequency) {
    Map grating;
    grating.record.lowest = 0.2;
    grating.record.highest = 0.8;
    grating.record.centre_x = 0.03;
    grating.record.centre_y = -0.01;
    grating.record.per_mm = 5;
    grating.turn(std::atan2(4, 3));
    EXPECT_NEAR(std::abs(coefficient(grating, 0, 0) - 0.5), 0, 1e-12);
    const auto fundamental = coefficient(grating, 3, 4);
    EXPECT_NEAR(std::abs(fundamental), 0.15, 1e-12);
    EXPECT_NEAR(std::arg(fundamental), -two_pi * (3 * 0.03 - 4 * 0.01), 1e-11);
    EXPECT_NEAR(std::abs(coefficient(grating, 6, 8)), 0, 1e-12);
    EXPECT_NEAR(grating(0.03, -0.01), 0.8, 1e-15);
    grating.turn(-std::atan2(4, 3)); // wrong twin: the angle the other way
    EXPECT_LT(std::abs(coefficient(grating, 3, 4)), 1e-12);
}

TEST(Reflectance, ASquareGratingHasOddHarmonics) {
    Map grating;
    grating.record.per_mm = 4;
    grating.record.square = 1;
    EXPECT_NEAR(coefficient(grating, 0, 0).real(), 0.5, 1e-12);
    for (const int order : {1, 2, 3}) {
        const double expected = order % 2 == 0 ? 0 : (order == 1 ? 1 : -1) / (order * two_pi / 2);
        EXPECT_NEAR(coefficient(grating, 4 * order, 0).real(), expected, 2e-3) << order; // 100 points a period
    }
    EXPECT_EQ(grating(0.24 / 4, 0), 1);
    EXPECT_EQ(grating(0.26 / 4, 0), 0);
}

TEST(Reflectance, ACheckerboardHasItsCornerAtTheOrigin) {
    Map board;
    board.record.kind = f64::PATTERN_CHECKERBOARD;
    board.record.per_mm = 10;
    board.record.lowest = 0.1;
    for (const Point p : points(1000, 1)) {
        const auto square = [](double u) { return static_cast<long>(std::floor(10 * u)); };
        EXPECT_EQ(board(p.x, p.y), (square(p.x) + square(p.y)) % 2 == 0 ? 1 : 0.1) << p.x << " " << p.y;
    }
    board.turn(two_pi / 4); // a quarter turn exchanges the colours
    EXPECT_EQ(board(0.01, 0.01), 0.1);
}

TEST(Reflectance, AStarIsACosineOfTheAzimuth) {
    Map star;
    star.record.kind = f64::PATTERN_STAR;
    star.record.centre_x = 0.1;
    for (const int cycles : {1, 2, 7, 36, 144, 1024}) {
        star.record.cycles = cycles;
        for (const double angle : {0.0, 0.3}) {
            star.turn(angle);
            const FloatMap in_float{&star};
            for (const Point p : points(200, 1)) {
                const double azimuth = std::atan2(p.y, p.x - 0.1) - angle;
                EXPECT_NEAR(star(p.x, p.y), 0.5 + 0.5 * std::cos(cycles * azimuth), 1e-12 * cycles);
                EXPECT_NEAR(in_float(static_cast<float>(p.x), static_cast<float>(p.y)), star(p.x, p.y), 1e-5 * cycles);
            }
        }
    }
    EXPECT_EQ(star(0.1, 0), 1); // the centre has no azimuth
}

// The grid's points lie at odd halves of a pitch; beyond its outer pixels the values are the reflections of SciPy's
// "reflect" (scipy.ndimage: d c b a | a b c d | d c b a), here counted by hand.
TEST(Reflectance, AGridIsLinearBetweenItsPointsAndGoesOnMirrored) {
    Map grid;
    grid.record.kind = f64::PATTERN_GRID;
    grid.record.per_mm = 10;
    grid.record.columns = 4;
    grid.record.rows = 3;
    grid.record.centre_x = 0.5;
    grid.record.centre_y = -0.2;
    grid.values = {0.1, 0.2, 0.4, 0.9, 0.3, 0.3, 0.8, 0.5, 0.6, 0.7, 0.0, 1.0};
    const auto at = [&](double column, double row) {
        return grid(0.5 + (column - 1.5) * 0.1, -0.2 + (row - 1.0) * 0.1);
    };
    const std::array<int, 12> columns = {3, 2, 1, 0, 0, 1,
                                         2, 3, 3, 2, 1, 0};                // expected columns for the numbers -4 to 7
    const std::array<int, 12> rows = {2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0, 1}; // expected rows for -4 to 7
    const auto value = [&](int column, int row) {
        return grid.pattern_point(grid.record, columns[static_cast<std::size_t>(column + 4)],
                                  rows[static_cast<std::size_t>(row + 4)]);
    };
    for (int row = -4; row < 7; ++row) {
        for (int column = -4; column < 7; ++column) {
            EXPECT_NEAR(at(column, row), value(column, row), 1e-12) << column << " " << row;
            const double mixed = 0.75 * (0.6 * value(column, row) + 0.4 * value(column + 1, row)) +
                                 0.25 * (0.6 * value(column, row + 1) + 0.4 * value(column + 1, row + 1));
            EXPECT_NEAR(at(column + 0.4, row + 0.25), mixed, 1e-12) << column << " " << row;
        }
    }
    const FloatMap in_float{&grid};
    for (const Point p : points(500, 3)) {
        EXPECT_NEAR(in_float(static_cast<float>(p.x), static_cast<float>(p.y)), grid(p.x, p.y), 1e-4);
    }
}

namespace {

// A scene that says whether there is a map.
struct Scene {
    f64::uint present;
    f64::uint features() const { return present; }
    double pattern_point(const f64::Pattern&, int, int) const { return 0.25; }
};

} // namespace

TEST(Reflectance, ScalesEveryLobeAndNothingWithoutAMap) {
    f64::SpecimenRecord specimen{};
    specimen.material.lobe_0.weight = 0.4;
    specimen.material.lobe_1.weight = 0.3;
    specimen.material.lobe_2.weight = 0.2;
    specimen.material.lobe_3.weight = 0.1;
    specimen.reflectance = {0, 1, 0, 0, 1, 0, 1, 1, 1, 1, 0, 0, f64::PATTERN_GRID};
    const auto with = f64::material_at(Scene{f64::FEATURE_REFLECTANCE_MAP}, specimen, {0.3, 0.4, 0});
    EXPECT_DOUBLE_EQ(with.lobe_0.weight, 0.1);
    EXPECT_DOUBLE_EQ(with.lobe_1.weight, 0.075);
    EXPECT_DOUBLE_EQ(with.lobe_2.weight, 0.05);
    EXPECT_DOUBLE_EQ(with.lobe_3.weight, 0.025);
    const auto without = f64::material_at(Scene{0}, specimen, {0.3, 0.4, 0});
    EXPECT_EQ(without.lobe_0.weight, 0.4);
    EXPECT_EQ(without.lobe_3.weight, 0.1);
    EXPECT_EQ(f64::reflectance_share(Scene{0}, specimen, {0.3, 0.4, 0}), 1);
}
