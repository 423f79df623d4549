// The places of focus curves' maxima near the ends of a scan.
#include "topography/places_of_maxima.hpp"

#include "topography/axial_average.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace vkfv::topography {
namespace {

// A Gaussian's maximum after both averages.
struct Averaged {
    int image;        // of the largest value; 0 or images - 1: at an end
    double at;        // in points of the curve
    double curvature; // of its logarithm there, by three values
};

// Averages a Gaussian about `place` as single images and as a curve, by the shares that the evaluation uses: this is
// the truth of the test.
Averaged averaged(double place, double width, const std::vector<double>& weights, int images) {
    std::vector<double> curve;
    for (int k = 0; k < images; ++k)
        curve.push_back(std::exp(-std::pow(k - place, 2) / (2 * width * width)));
    for (int average = 0; average < 2; ++average) {
        const auto before = curve;
        for (int k = 0; k < images; ++k) {
            curve[static_cast<std::size_t>(k)] = 0;
            for (const Share& share : axial_shares(weights, k, images))
                curve[static_cast<std::size_t>(k)] +=
                    static_cast<double>(share.weight) * before[static_cast<std::size_t>(share.image)];
        }
    }
    const auto largest = std::ranges::max_element(curve);
    const auto at = static_cast<double>(largest - curve.begin());
    if (largest == curve.begin() || largest + 1 == curve.end())
        return {.image = static_cast<int>(at), .at = at, .curvature = 0};
    const double before = std::log(largest[-1]), here = std::log(largest[0]), after = std::log(largest[1]);
    return {.image = static_cast<int>(at),
            .at = at + 0.5 * (before - after) / (before - 2 * here + after),
            .curvature = 2 * here - before - after};
}

double found(double place, double width, const std::vector<double>& weights, int images) {
    return averaged(place, width, weights, images).at;
}

double between(const std::vector<double>& places, double at) {
    const auto before = static_cast<std::size_t>(at);
    return std::lerp(places[before], places[before + 1], at - std::floor(at));
}

struct Stack {
    int images;
    double smoothing, width; // in steps
};

// The places are found of curves as wide as the stack's and of curves a quarter wider. The wrong twin is a straight
// line through the images' places.
TEST(PlacesOfMaxima, AreThoseOfTheCurvesNearBothEnds) {
    for (const Stack stack :
         {Stack{10, 0.66, 1}, Stack{21, 2, 3}, Stack{31, 3, 4}, Stack{60, 2, 3}, Stack{101, 4, 6}}) {
        const auto weights = axial_weights(stack.smoothing);
        const auto places = places_of_maxima(weights, stack.images, stack.width, {});
        const auto line = places_of_maxima(weights, stack.images, 0, {});
        double worst = 0, worst_wider = 0, worst_of_line = 0;
        for (int tenths = 0; tenths <= 10 * (stack.images - 1); ++tenths) {
            const double place = 0.1 * tenths;
            const double at = found(place, stack.width, weights, stack.images);
            if (at == 0 || at == stack.images - 1)
                continue;
            worst = std::max(worst, std::abs(between(places, at) - place));
            worst_of_line = std::max(worst_of_line, std::abs(between(line, at) - place));
            const double wider = found(place, 1.25 * stack.width, weights, stack.images);
            if (wider > 0 && wider < stack.images - 1)
                worst_wider = std::max(worst_wider, std::abs(between(places, wider) - place));
        }
        EXPECT_LT(worst, 0.1) << stack.images;
        EXPECT_LT(worst_wider, 0.2) << stack.images;
        EXPECT_GT(worst_of_line, 1.5 * worst) << stack.images;
    }
}

TEST(PlacesOfMaxima, AreThePointsAwayFromTheEndsAndMirrorImages) {
    const auto places = places_of_maxima(axial_weights(2), 60, 3, {});
    for (std::size_t k = 12; k < 48; ++k)
        EXPECT_EQ(places[k], static_cast<double>(k));
    for (std::size_t k = 0; k < 60; ++k)
        EXPECT_NEAR(places[k] + places[59 - k], 59, 1e-12);
    for (std::size_t k = 1; k < 60; ++k)
        EXPECT_GT(places[k], places[k - 1]);
    // Without averages, and of curves of no form, there is nothing to put right.
    for (const double smoothing : {0.0, 2.0}) {
        const auto points = averaged_points(axial_weights(smoothing), 15);
        const auto unknown = places_of_maxima(axial_weights(smoothing), 15, smoothing > 0 ? 0 : 3, {});
        for (std::size_t k = 0; k < 15; ++k)
            EXPECT_EQ(unknown[k], points[k].position);
    }
}

// Curves are half to twice as wide as the stack's, and only the curve tells its width.
TEST(PlacesByWidth, AreThoseOfEveryCurveByItsOwnWidth) {
    for (const Stack stack : {Stack{21, 1, 1.5}, Stack{31, 2, 2.5}, Stack{60, 2, 3}, Stack{101, 4, 6}}) {
        const auto weights = axial_weights(stack.smoothing);
        const PlacesByWidth by_width(weights, stack.images, stack.width, {});
        double worst = 0, worst_of_the_stack = 0, worst_width = 0;
        for (const double ratio : {0.5, 0.7, 1.0, 1.3, 2.0}) {
            for (int tenths = 0; tenths <= 10 * (stack.images - 1); ++tenths) {
                const double place = 0.1 * tenths;
                const auto [image, at, curvature] = averaged(place, ratio * stack.width, weights, stack.images);
                // No maximum is found nearer to an end than half a step, and the table begins a little later.
                constexpr double first = 0.65;
                if (at < first || at > stack.images - 1 - first || !by_width.feels_an_end(at))
                    continue;
                const auto width = by_width.width(image, at - image, curvature);
                worst = std::max(worst, std::abs(by_width.place(at, width.logarithm) - place));
                worst_of_the_stack = std::max(worst_of_the_stack, std::abs(by_width.place(at, 0) - place));
                if (width.weight > 1)
                    worst_width = std::max(worst_width, std::abs(std::exp(width.logarithm) / ratio - 1));
            }
        }
        // Two widths of the table are a sixth apart, and places a twentieth of a step.
        EXPECT_LT(worst, 0.03) << stack.images;
        EXPECT_LT(worst_width, 0.03) << stack.images;
        EXPECT_GT(worst_of_the_stack, 0.1) << stack.images;
    }
}

TEST(PlacesByWidth, TakesTheNearestWidthWhereNoneIsLikeThatAndNoneWhereNoEndIsFelt) {
    const PlacesByWidth by_width(axial_weights(2), 60, 3, {});
    EXPECT_LT(by_width.width(5, 0, 10).logarithm, -0.6);
    EXPECT_GT(by_width.width(5, 0, 1e-6).logarithm, 0.6);
    EXPECT_EQ(by_width.width(5, 0, 0).weight, 0);
    EXPECT_FALSE(by_width.feels_an_end(12));
    EXPECT_FALSE(by_width.feels_an_end(47));
    EXPECT_NEAR(by_width.place(4.3, 0.2) + by_width.place(54.7, 0.2), 59, 1e-12);
    EXPECT_FALSE(PlacesByWidth(axial_weights(0), 60, 3, {}).feels_an_end(1));
    EXPECT_FALSE(PlacesByWidth(axial_weights(2), 60, 0, {}).feels_an_end(1));
    EXPECT_FALSE(PlacesByWidth().feels_an_end(0));
}

TEST(CurvatureAtMaximum, IsThatOfAGaussian) {
    for (const double width : {0.6, 1.0, 3.0, 50.0})
        for (const double offset : {-0.5, -0.2, 0.0, 0.4}) {
            const auto value = [&](int k) { return std::exp(-0.5 * std::pow((k - offset) / width, 2)); };
            const double bend = (2 * value(0) - value(-1) - value(1)) / value(0);
            EXPECT_NEAR(curvature_at_maximum(bend, offset) * width * width, 1, 1e-9) << width << ' ' << offset;
        }
    EXPECT_EQ(curvature_at_maximum(0, 0), 0);
    EXPECT_EQ(curvature_at_maximum(-0.1, 0.2), 0);
    EXPECT_EQ(curvature_at_maximum(2, 0), 0);
}

} // namespace
} // namespace vkfv::topography
