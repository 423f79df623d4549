// The search for how far something goes on finds the bits of bisection alone, by fewer questions.
#include "optics/aim/farthest.hpp"

#include "optics/aim/apertures.hpp"
#include "optics/instrument/image_quality.hpp"
#include "parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace vkfv::optics {
namespace {

// The truth: the largest t of steps of limit / 32 at which it holds, then bisection. Nothing else is known of the edge.
template <class Excess>
std::optional<double> by_bisection(double limit, const Excess& excess, int bisections) {
    for (int step = 32; step >= 0; --step) {
        double inside = limit * step / 32;
        if (!(excess(inside) <= 0)) {
            continue;
        }
        double outside = limit * std::min(step + 1, 32) / 32;
        for (int i = 0; i < bisections; ++i) {
            const double middle = 0.5 * (inside + outside);
            (excess(middle) <= 0 ? inside : outside) = middle;
        }
        return inside;
    }
    return std::nullopt;
}

struct Counted {
    double (*excess)(double);
    mutable int asked = 0;
    double operator()(double t) const {
        ++asked;
        return excess(t);
    }
};

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Farthest, IsThatOfBisectionToTheLastBit) {
    constexpr double (*edges[])(double) = {
        [](double t) { return t * t - 0.1234567; },                   // smooth
        [](double t) { return t < 0.31 ? -1.0 : 1.0; },               // a jump
        [](double t) { return t < 0.31 ? t * t - 0.1 : infinity; },   // ends before its edge
        [](double t) { return std::max(t - 0.3, 40 * (t - 0.299)); }, // a kink
        [](double t) { return std::cbrt(t - 0.777); },                // steep at the edge
        [](double t) {
            const double d = t - 0.5;
            return d * d * d;
        },                                                 // flat at the edge
        [](double) { return -1.0; },                       // everywhere
        [](double t) { return t == 0 ? 0.0 : infinity; }}; // at 0 alone
    for (const auto edge : edges) {
        for (const double limit : {1.0, 1.0370370370370370, 0.8}) {
            for (const int bisections : {26, 45}) {
                EXPECT_EQ(farthest(limit, Counted{edge}, bisections), by_bisection(limit, edge, bisections));
            }
        }
    }
    EXPECT_EQ(farthest(1, Counted{[](double) { return infinity; }}), std::nullopt);
}

TEST(Farthest, AsksLittleOfASmoothEdge) {
    const Counted smooth{[](double t) { return t * t - 0.1234567; }};
    (void)farthest(1.0, smooth);
    const Counted jump{[](double t) { return t * t < 0.1234567 ? -1.0 : infinity; }};
    (void)farthest(1.0, jump);
    EXPECT_LE(smooth.asked, 22 + 12); // 22 steps inward
    EXPECT_GE(jump.asked, 22 + 40);   // nothing but bisection is left
}

// The truth is tracing with and without apertures, which says only whether light comes through.
TEST(Farthest, ExcessSaysWhatTheTraceDoes) {
    const Instrument instrument = assemble(test::microscope());
    const Imaging imaging = imaging_of(instrument);
    int passed = 0;
    for (int i = 0; i < 200; ++i) {
        const glm::dvec2 field(0.001 * (i % 7), 0.002 * (i % 5));
        const glm::dvec2 cosines(0.35 * std::cos(i) * (i / 200.0), 0.35 * std::sin(i));
        const bool passes = imaging.trace(field, 0, cosines).has_value();
        EXPECT_EQ(imaging.excess(field, 0, cosines) <= 0, passes);
        passed += passes ? 1 : 0;
    }
    EXPECT_GT(passed, 20);
    EXPECT_LT(passed, 180);
    // The cone ends where its light is 0 beyond the edge.
    const Outline outline = outline_at(imaging, {0, 0});
    EXPECT_NEAR(imaging.excess({0, 0}, 0, outline.cosines(0, outline.radii[0])), 0, 1e-12);
    EXPECT_GT(imaging.excess({0, 0}, 0, outline.cosines(0, outline.radii[0] * (1 + 1e-9))), 0);
}

} // namespace
} // namespace vkfv::optics
