#include "dimensions/evaluate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <random>
#include <string>

namespace vkfv::dimensions {
namespace {

using surface::HeightMap;

constexpr int points = 96, seeds = 60;
constexpr double pitch = 5e-4, deviation = 5e-5; // mm
constexpr double degrees = 3.14159265358979323846 / 180, turn = 360 * degrees;

using Height = std::function<double(double u, double v)>;

struct Standard {
    std::string name;
    Feature feature;
    Frame frame;
    Height height;
};

double line_height(double u, double period, double width, double wall) {
    return std::clamp((width / 2 - std::abs(u - period * std::round(u / period))) / wall + 0.5, 0.0, 1.0);
}

std::vector<Standard> standards() {
    const double middle = 0.5 * (points - 1) * pitch;
    const Frame frame{.x = middle, .y = middle, .angle = 7 * degrees};
    const double radius = 0.2, rim = 0.02;
    const auto wave = [](double period) {
        return [=](double u, double) { return 5e-4 * std::cos(turn * u / period); };
    };
    return {{"step", Step{frame, 0.002}, frame, [](double u, double) { return u > 0 ? 0.002 : 0.0; }},
            {"groove", Groove{frame, 0.012, 0.002}, frame,
             [](double u, double) { return -0.002 * std::clamp((0.006 - std::abs(u)) / 0.0015 + 0.5, 0.0, 1.0); }},
            {"sphere", SphereCap{frame, radius, radius - std::sqrt(radius * radius - rim * rim)}, frame,
             [=](double u, double v) {
                 const double square = std::min(u * u + v * v, rim * rim);
                 return std::sqrt(radius * radius - square) - std::sqrt(radius * radius - rim * rim);
             }},
            {"sinusoid", Sinusoid{frame, 5e-4, 0.0093}, frame, wave(0.0093)},
            {"sinusoid of 10 points", Sinusoid{frame, 5e-4, 0.005}, frame, wave(0.005)},
            {"grating", Grating{frame, 0.0083, 0, 0}, frame,
             [](double u, double) { return 0.001 * line_height(u, 0.0083, 0.004, 0.0012); }},
            {"cross-grating", CrossGrating{frame, 0.0083, 0.0091, 90 * degrees}, frame, [](double u, double v) {
                 return 0.001 * std::max(line_height(u, 0.0083, 0.004, 0.0012), line_height(v, 0.0091, 0.004, 0.0012));
             }}};
}

// White noise, averaged over window x window points as a focus window does, of the same standard deviation.
Grid<double> noise(unsigned seed, int window) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0, deviation / window);
    const int size = points + window - 1;
    Grid<double> white(size, size), rows(points, size), result(points, points);
    for (double& value : white.values)
        value = normal(random);
    for (int row = 0; row < size; ++row)
        for (int column = 0; column < points; ++column)
            for (int k = 0; k < window; ++k)
                rows(column, row) += white(column + k, row);
    for (int row = 0; row < points; ++row)
        for (int column = 0; column < points; ++column)
            for (int k = 0; k < window; ++k)
                result(column, row) += rows(column, row + k);
    return result;
}

HeightMap made(const Standard& standard, const Grid<double>& noise) {
    HeightMap map{.height = noise, .x0 = 0, .y0 = 0, .pitch_x = pitch, .pitch_y = pitch};
    for (int row = 0; row < points; ++row)
        for (int column = 0; column < points; ++column)
            map.height(column, row) += standard.height(standard.frame.u(map.x(column), map.y(row)),
                                                       standard.frame.v(map.x(column), map.y(row)));
    return map;
}

// A dimension in all maps, and by how many of its standard errors it is off its value without noise.
struct Found {
    std::string name; // of the standard, the noise and the dimension
    std::vector<double> errors_off;
};

std::vector<Found> found_of(const Standard& standard, int window) {
    std::vector<Found> result;
    const auto clean = evaluate(made(standard, Grid<double>(points, points)), standard.feature);
    for (const auto& one : clean)
        result.push_back(
            {.name = standard.name + ", window of " + std::to_string(window) + ", " + one.name, .errors_off = {}});
    for (unsigned seed = 1; seed <= seeds; ++seed) {
        const auto found = evaluate(made(standard, noise(seed, window)), standard.feature);
        for (std::size_t k = 0; k < clean.size(); ++k)
            result[k].errors_off.push_back(std::abs(found[k].value - clean[k].value) / found[k].standard_error);
    }
    std::erase_if(result, [](const Found& one) { return one.name.ends_with("Sz") || one.name.ends_with("Sq"); });
    return result;
}

// All dimensions in all maps, made once for both tests.
const std::vector<Found>& all_found() {
    static const std::vector<Found> all = [] {
        std::vector<Found> result;
        for (const auto& standard : standards())
            for (const int window : {1, 7})
                std::ranges::move(found_of(standard, window), std::back_inserter(result));
        return result;
    }();
    return all;
}

// The number of maps within 1, 2 and 3 errors, if these were `factor` times as large.
std::array<int, 3> within(const Found& one, double factor) {
    std::array<int, 3> result{};
    for (std::size_t k = 0; k < 3; ++k)
        result.at(k) = static_cast<int>(std::ranges::count_if(
            one.errors_off, [&](double off) { return off <= factor * static_cast<double>(k + 1); }));
    return result;
}

// Whether the shares of 60 maps are 68.3, 95.4 and 99.7 %, to three and a half standard deviations of the binomial
// distribution: 1 of 40 sets of 50 comparisons goes wrong by chance.
bool honest(const std::array<int, 3>& within) {
    return within[0] >= 29 && within[0] <= 53 && within[1] >= 52 && within[2] >= 57;
}

TEST(Coverage, DimensionsLieWithinTheirStandardErrorsAsOftenAsTheySay) {
    for (const auto& one : all_found()) {
        const auto counts = within(one, 1);
        EXPECT_TRUE(honest(counts)) << one.name << ": " << counts[0] << ", " << counts[1] << ", " << counts[2] << " of "
                                    << seeds;
    }
}

// The wrong twins are errors half and twice as large.
TEST(Coverage, ErrorsHalfOrTwiceAsLargeAreNotHonest) {
    for (const double factor : {0.5, 2.0})
        for (const auto& one : all_found())
            EXPECT_FALSE(honest(within(one, factor))) << factor << ", " << one.name;
}

} // namespace
} // namespace vkfv::dimensions
