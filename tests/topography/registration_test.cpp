#include "topography/registration.hpp"

#include "core/mathematics/units.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace vkfv::topography {
namespace {

// A sum of waves of random direction, length and phase: it can be drawn at any place, shift and scale.
class Pattern {
  public:
    explicit Pattern(unsigned seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> uniform;
        for (int k = 0; k < 200; ++k) {
            const double direction = 2 * pi * uniform(random), frequency = 0.02 + 0.13 * uniform(random);
            waves_.push_back({frequency * std::cos(direction), frequency * std::sin(direction), uniform(random)});
        }
    }
    // The pattern shifted, and scaled about its middle.
    Grid<float> drawn(int columns, int rows, const ImageTransform& transform) const {
        Grid<float> image(columns, rows);
        for (int row = 0; row < rows; ++row) {
            for (int column = 0; column < columns; ++column) {
                // The point of the reference that is seen here stands at these coordinates.
                const double x = (column - 0.5 * (columns - 1) - transform.shift_x) / transform.scale;
                const double y = (row - 0.5 * (rows - 1) - transform.shift_y) / transform.scale;
                double sum = 0;
                for (const Wave& wave : waves_) {
                    sum += std::cos(2 * pi * (wave.x * x + wave.y * y + wave.phase));
                }
                image(column, row) = static_cast<float>(100 + sum);
            }
        }
        return image;
    }

  private:
    struct Wave {
        double x, y, phase;
    };
    std::vector<Wave> waves_;
};

constexpr int columns = 200, rows = 160;

TEST(Registration, FindsAShift) {
    const Pattern pattern(1);
    const auto reference = pattern.drawn(columns, rows, {});
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {0.4, -0.3}, {7.25, 3.5}, {-12.6, 20.2}}) {
        const auto found =
            registered(reference, pattern.drawn(columns, rows, {.shift_x = x, .shift_y = y}), Registration::shift);
        EXPECT_NEAR(found.shift_x, x, 0.05);
        EXPECT_NEAR(found.shift_y, y, 0.05);
        EXPECT_EQ(found.scale, 1);
    }
}

TEST(Registration, FindsAScale) {
    const Pattern pattern(2);
    const auto reference = pattern.drawn(columns, rows, {});
    for (const double scale : {1.0, 1.004, 0.99}) {
        const ImageTransform given{.shift_x = 1.3, .shift_y = -2.1, .scale = scale};
        const auto found = registered(reference, pattern.drawn(columns, rows, given), Registration::shift_and_scale);
        EXPECT_NEAR(found.shift_x, given.shift_x, 0.1);
        EXPECT_NEAR(found.shift_y, given.shift_y, 0.1);
        EXPECT_NEAR(found.scale, scale, 0.0006);
        // The wrong twin is the inverse, another transform.
        EXPECT_GT(std::abs(found.shift_x - given.inverse().shift_x), 1);
    }
}

TEST(Registration, TransformsFollowEachOther) {
    const ImageTransform first{.shift_x = 3, .shift_y = -1, .scale = 1.02};
    const ImageTransform second{.shift_x = -5, .shift_y = 2, .scale = 0.97};
    const auto none = first.then(second).then(second.inverse()).then(first.inverse());
    EXPECT_NEAR(none.shift_x, 0, 1e-12);
    EXPECT_NEAR(none.shift_y, 0, 1e-12);
    EXPECT_NEAR(none.scale, 1, 1e-12);
}

TEST(Registration, LaysImagesOverEachOther) {
    const Pattern pattern(3);
    std::vector<ImageTransform> given, steps;
    std::vector<Grid<float>> images;
    for (int k = 0; k < 5; ++k) {
        given.push_back({.shift_x = 1.5 * k, .shift_y = 0.7 * k * k, .scale = 1 + 0.002 * k});
        images.push_back(pattern.drawn(columns, rows, given.back()));
        steps.push_back(
            k == 0 ? ImageTransform{}
                   : registered(images[static_cast<std::size_t>(k - 1)], images.back(), Registration::shift_and_scale));
    }
    const auto transforms = in_common_frame(steps);
    const auto& middle = images[2];
    double before = 0, after = 0;
    for (std::size_t k = 0; k < images.size(); ++k) {
        const auto laid = resampled({images[k]}, transforms[k]).front();
        for (int row = 30; row < rows - 30; ++row) {
            for (int column = 30; column < columns - 30; ++column) {
                before += std::pow(images[k](column, row) - middle(column, row), 2);
                after += std::pow(laid(column, row) - middle(column, row), 2);
            }
        }
    }
    EXPECT_LT(after, 0.01 * before);
}

} // namespace
} // namespace vkfv::topography
