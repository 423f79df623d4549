#include "core/messages/error.hpp"
#include "focus/focus.hpp"
#include "topography/peak_method.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace vkfv::topography {
namespace {

using namespace focus::f64;

struct Curve {
    std::vector<double> values;
    double curve_value(int image) const { return values.at(static_cast<std::size_t>(image)); }
    double joint_value(int image) const { return curve_value(image); }
    double alone_value(int image) const { return curve_value(image); }
};

// The samples f(-range) ... f(range) of a curve with its maximum at the image `range`.
Curve sampled(const std::function<double(double)>& f, int range) {
    Curve curve;
    for (int x = -range; x <= range; ++x)
        curve.values.push_back(f(x));
    return curve;
}

std::function<double(double)> gaussian(double centre, double width) {
    return [=](double z) { return 5 * std::exp(-0.5 * std::pow((z - centre) / width, 2)); };
}

FocusPlan plan_of(int method, int range) {
    FocusPlan plan{};
    plan.peak = method;
    plan.peak_range = range;
    return plan;
}

double located(int method, const Curve& curve, int range) {
    const PeakFit fit = locate_peak(curve, plan_of(method, range), static_cast<int>(curve.values.size()) / 2, range);
    EXPECT_EQ(fit.found, 1);
    return fit.offset;
}

TEST(Peak, ThreePointAndFittedGaussiansAreExactForAGaussianAnywhereBetweenSteps) {
    for (double centre = -0.5; centre <= 0.5; centre += 0.0625)
        for (const double width : {0.7, 3.0, 10.0}) {
            // The logarithms' rounding, 2e-16, is divided by the curvature 1 / width^2 >= 0.01.
            EXPECT_NEAR(located(PEAK_GAUSSIAN, sampled(gaussian(centre, width), 1), 1), centre, 1e-13);
            for (const int range : {1, 2, 6}) {
                const Curve curve = sampled(gaussian(centre, width), range);
                EXPECT_NEAR(located(PEAK_GAUSSIAN_FIT, curve, range), centre, 1e-12); // sums of 13 such
                EXPECT_NEAR(gaussian_residual(curve, range, range), 0, 1e-14);
            }
        }
    // The wrong twin, a parabola through the values themselves, is off by more than 0.02 steps.
    EXPECT_GT(std::abs(located(PEAK_PARABOLA, sampled(gaussian(0.3, 0.7), 1), 1) - 0.3), 0.02);
}

TEST(Peak, ParabolasAreExactForAParabola) {
    for (double centre = -0.5; centre <= 0.5; centre += 0.0625) {
        const auto parabola = [=](double z) { return 50 - std::pow(z - centre, 2); };
        // Values of 50 are right to 1e-14, and the curvature is 2.
        EXPECT_NEAR(located(PEAK_PARABOLA, sampled(parabola, 1), 1), centre, 1e-14);
        for (const int range : {1, 3, 6})
            EXPECT_NEAR(located(PEAK_POLYNOMIAL_FIT, sampled(parabola, range), range), centre, 1e-13);
    }
    // The wrong twin is the fit of a Gaussian.
    const auto parabola = [](double z) { return 50 - std::pow(z - 0.3, 2); };
    EXPECT_GT(std::abs(located(PEAK_GAUSSIAN, sampled(parabola, 1), 1) - 0.3), 1e-4);
}

TEST(Peak, APolynomialFitIsThatOfTheNormalEquations) {
    // The normal equations over -R..R with S2 = sum x^2, S4 = sum x^4, n = 2 R + 1 give the slope at the middle, sum x
    // y / S2, and half the curvature, (n sum x^2 y - S2 sum y) / (n S4 - S2^2).
    std::mt19937 random(5);
    std::normal_distribution<double> normal(0, 0.05);
    for (const int range : {2, 5}) {
        const Curve curve = sampled([&](double z) { return gaussian(0.2, 3)(z) + normal(random); }, range);
        double n = 0, s2 = 0, s4 = 0, y = 0, xy = 0, xxy = 0;
        for (int x = -range; x <= range; ++x) {
            const double value = curve.values[static_cast<std::size_t>(x + range)];
            n += 1, s2 += x * x, s4 += x * x * x * x, y += value, xy += x * value, xxy += x * x * value;
        }
        const double bend = (n * xxy - s2 * y) / (n * s4 - s2 * s2);
        EXPECT_NEAR(located(PEAK_POLYNOMIAL_FIT, curve, range), -xy / s2 / (2 * bend), 1e-12);
    }
}

TEST(Peak, TheCentreOfGravityIsThatOfWhatStandsAboveTheSmallestValue) {
    // A triangle of height 4 and half width 4, shifted by a half, above a pedestal of 7: values 7 +
    // (0.5 1.5 2.5 3.5 3.5 2.5 1.5), of which the smallest falls away: (1*-2 + 2*-1 + 3*0 + 3*1 + 2*2 + 1*3) / 12.
    EXPECT_NEAR(located(PEAK_CENTRE_OF_GRAVITY, Curve{{7.5, 8.5, 9.5, 10.5, 10.5, 9.5, 8.5}}, 3), 6.0 / 12, 1e-15);
    // The centre of gravity of a Gaussian whose feet are in the range is its centre, but for the tail cut off, exp(-0.5
    // (5.7/1.2)^2) = 1e-5.
    EXPECT_NEAR(located(PEAK_CENTRE_OF_GRAVITY, sampled(gaussian(0.3, 1.2), 6), 6), 0.3, 1e-3);
}

TEST(Peak, FitsHaveTheNoiseOfTheirClosedForms) {
    // Each standard deviation of 4000 noisy Gaussians is known to 1 / sqrt(8000) = 1.1 %.
    std::mt19937 random(7);
    std::normal_distribution<double> normal(0, 0.02);
    const auto deviation = [&](int method) {
        double sum = 0, squares = 0;
        constexpr int curves = 4000;
        for (int k = 0; k < curves; ++k) {
            const Curve curve = sampled([&](double z) { return gaussian(0.2, 6)(z) + normal(random); }, 5);
            const double offset = located(method, curve, 5);
            sum += offset;
            squares += offset * offset;
        }
        return std::sqrt(squares / curves - std::pow(sum / curves, 2));
    };
    // The Gaussian fit's weights are those of least noise: 0.02 / sqrt(sum (dy/dcentre)^2) by Cramer and Rao, with
    // dy/dcentre = y x / 6^2.
    double information = 0;
    for (int x = -5; x <= 5; ++x)
        information += std::pow(gaussian(0.2, 6)(x) * (x - 0.2) / 36, 2);
    EXPECT_NEAR(deviation(PEAK_GAUSSIAN_FIT) / (0.02 / std::sqrt(information)), 1, 0.055); // five of 1.1 %: rate 6e-7
    // The parabola's vertex has the noise of its slope, 0.02 / sqrt(sum x^2), over twice its bend.
    const double bend = 5 * fit_parabola(sampled(gaussian(0.2, 6), 5), 5, 5, 0).bend;
    EXPECT_NEAR(deviation(PEAK_POLYNOMIAL_FIT) / (0.02 / std::sqrt(110) / (2 * std::abs(bend))), 1, 0.055);
}

TEST(Peak, ThereIsNoneWithoutAMaximum) {
    EXPECT_EQ(gaussian_peak(1.0, 1.0, 1.0).found, 0);
    EXPECT_EQ(gaussian_peak(1.0, 2.0, 3.0).found, 0);
    EXPECT_EQ(gaussian_peak(2.0, 1.0, 2.0).found, 0);
    EXPECT_EQ(gaussian_peak(0.0, 1.0, 0.5).found, 0);
    EXPECT_DOUBLE_EQ(gaussian_peak(1.0, 2.0, 2.0).offset, 0.5);
    EXPECT_EQ(parabola_peak(1.0, 1.0, 1.0).found, 0);
    for (int method = 0; method < PEAK_METHOD_COUNT; ++method) {
        EXPECT_EQ(locate_peak(Curve{{0, 0, 0}}, plan_of(method, 1), 1, 1).found, 0);
        EXPECT_EQ(locate_peak(Curve{{1}}, plan_of(method, 1), 0, 0).found, 0);
    }
    EXPECT_EQ(locate_peak(Curve{{2, 2, 2}}, plan_of(PEAK_POLYNOMIAL_FIT, 1), 1, 1).found, 0);
    EXPECT_EQ(locate_peak(Curve{{9, 2, 3, 2, 9}}, plan_of(PEAK_POLYNOMIAL_FIT, 2), 2, 2).found, 0);
}

TEST(Peak, OutsideTheRangeThereIsNone) {
    // The largest value stands in the middle of a rise that bends downwards: the fit's maximum lies beyond the range,
    // and no image out there is taken for the sharpest.
    const Curve curve{{1, 11, 19, 26.9, 26.8, 30, 34}};
    const FocusPlan plan = plan_of(PEAK_POLYNOMIAL_FIT, 3);
    const PeakFit fit = locate_peak(curve, plan, 3, 3);
    EXPECT_EQ(fit.found, 0);
    EXPECT_EQ(fit.offset, 0);
    EXPECT_EQ(follow_curve(curve, plan, empty_curve(), 3, 7).place, 3);
    // The wrong twin, the parabola, does have a maximum.
    const ParabolaFit parabola = fit_parabola(curve, 3, 3, 0);
    EXPECT_LT(parabola.bend, 0);
    EXPECT_GT((parabola.middle_1 + parabola.middle_2) / 2 - parabola.slope / (2 * parabola.bend), 3);
}

CurveRecord followed(const std::vector<double>& values, int range) {
    const Curve curve{values};
    const int images = static_cast<int>(values.size());
    CurveRecord record = empty_curve();
    for (int at = 0; at < images; ++at)
        record = follow_curve(curve, plan_of(PEAK_GAUSSIAN, range), record, at, std::min(images, at + range + 1)).curve;
    return record;
}

double position(const std::vector<double>& values) {
    const CurveRecord record = followed(values, 2);
    return record.found == 1 ? record.at + record.offset : std::nan("");
}

TEST(FocusCurve, FindsTheHighestOfSeveralPeaksAndNoneAtTheEnds) {
    EXPECT_DOUBLE_EQ(position({1, 2, 1, 1, 4, 1}), 4);
    EXPECT_DOUBLE_EQ(position({1, 4, 1, 1, 2, 1}), 1);
    EXPECT_DOUBLE_EQ(position({1, 2, 4, 4, 2, 1}), 2.5);
    EXPECT_TRUE(std::isnan(position({5, 4, 3, 2, 1})));
    EXPECT_TRUE(std::isnan(position({1, 2, 3, 4, 5})));
    EXPECT_TRUE(std::isnan(position({1, 4, 1, 1, 2, 5})));
    EXPECT_TRUE(std::isnan(position({3, 3, 3, 3})));
    EXPECT_DOUBLE_EQ(followed({1, 4, 1}, 2).sum, 6);
    EXPECT_DOUBLE_EQ(followed({1, 2, 3}, 2).largest, 3);
}

TEST(FocusCurve, CountsItsPeaks) {
    const auto peaks = [](const std::vector<double>& values, int range) {
        return count_peaks(followed(values, range), static_cast<int>(values.size()));
    };
    EXPECT_EQ(peaks({1, 1, 9, 1, 1, 1, 1, 1}, 2), 1);
    EXPECT_EQ(peaks({1, 1, 9, 1, 1, 8, 1, 1}, 2), 2);
    EXPECT_EQ(peaks({1, 1, 9, 1, 1, 3, 1, 1}, 2), 1); // the mean is 2.25, half way 5.6
    EXPECT_EQ(peaks({1, 1, 9, 1, 8, 1, 1, 1}, 2), 1); // within the range of the other
    EXPECT_EQ(peaks({1, 1, 9, 1, 8, 1, 1, 1}, 1), 2);
    EXPECT_EQ(peaks({1, 1, 9, 9, 1, 1, 1, 1}, 2), 1);          // a plateau is one
    EXPECT_EQ(peaks({1, 9, 1, 9, 1, 9, 1, 9, 1, 9, 1}, 1), 4); // or more
}

TEST(FocusCurve, TheResidualTellsASinglePeakFromOthers) {
    std::vector<double> one, two;
    for (int k = 0; k < 21; ++k) {
        one.push_back(gaussian(10.2, 3)(k));
        two.push_back(gaussian(8, 1.5)(k) + gaussian(12.5, 1.5)(k));
    }
    EXPECT_LT(followed(one, 6).residual, 1e-12); // exact but for rounding
    EXPECT_GT(followed(two, 6).residual, 0.05);
}

TEST(PeakMethod, IsKnownByName) {
    EXPECT_EQ(peak_method_from_name("gaussian"), PeakMethod::gaussian);
    EXPECT_EQ(peak_method_from_name("centre-of-gravity"), PeakMethod::centre_of_gravity);
    EXPECT_EQ(name_of(PeakMethod::polynomial_fit), "polynomial-fit");
    EXPECT_EQ(peak_method_names().size(), static_cast<std::size_t>(PEAK_METHOD_COUNT));
    EXPECT_THROW(peak_method_from_name("highest"), InputError);
}

} // namespace
} // namespace vkfv::topography
