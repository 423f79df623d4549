// A fit's statistics are those of closed forms, its search finds the parameters of a model that is known, and its
// sentences tell what a stack does not.
#include "core/messages/error.hpp"
#include "core/messages/json_text.hpp"
#include "measurement/fit/fit_documents.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace vkfv::measurement {
namespace {
namespace of_fit { // files of a unity build share the unnamed namespace

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

// A chessboard of this contrast: neighbours differ by twice the amplitude.
Grid<float> chessboard(int side, double mean, double amplitude) {
    Grid<float> image(side, side);
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            image(column, row) = static_cast<float>(mean + ((column + row) % 2 == 0 ? amplitude : -amplitude));
        }
    }
    return image;
}

constexpr double curve_width = 3, middle = 10; // images

StatisticsLayout layout_of_curves() {
    return {.images = 21, .pixels = ImageSize::square(32), .window = 8, .brightness = true};
}

// A stack whose contrast passes a Gaussian along the scan.
std::vector<double> gaussian_stack(double light, double contrast) {
    const auto layout = layout_of_curves();
    StackStatistics statistics(layout);
    for (int image = 0; image < layout.images; ++image) {
        const double from_middle = (image - middle) / curve_width;
        statistics.add(image, chessboard(32, light, light * contrast * std::exp(-0.5 * from_middle * from_middle)));
    }
    return statistics.values();
}

TEST(StackStatistics, AreThoseOfClosedForms) {
    const auto layout = layout_of_curves();
    const auto groups = statistic_groups(layout);
    const auto values = gaussian_stack(5, 0.1);
    std::vector<std::string> names;
    std::size_t count = 0;
    for (const auto& group : groups) {
        names.push_back(group.name);
        count += static_cast<std::size_t>(group.count);
    }
    EXPECT_THAT(names, testing::ElementsAre("brightness", "contrast", "sharpness_1", "sharpness_2", "sharpness_4",
                                            "likeness", "curves", "power"));
    ASSERT_EQ(values.size(), count);
    EXPECT_NEAR(values[10], 1, 1e-6);                       // every image is as bright
    EXPECT_NEAR(values[21 + 10], std::log(0.1), 1e-5);      // contrast in the middle
    EXPECT_NEAR(values[21 + 7], std::log(0.1) - 0.5, 1e-5); // and one standard deviation beside it
    EXPECT_NEAR(values[2 * 21 + 10], std::log(0.2), 1e-5);  // neighbours differ by twice the amplitude
    EXPECT_LT(values[3 * 21 + 10], std::log(1e-4));         // pairs of neighbours do not
    EXPECT_GT(values[5 * 21], 5);                           // a chessboard is like any other
    const std::size_t curves = 5 * 21 + 20;
    EXPECT_NEAR(values[curves], middle, 1e-4);
    // A square of a Gaussian has the standard deviation w / sqrt(2).
    EXPECT_NEAR(values[curves + 2], std::log(curve_width / std::sqrt(2.0)), 0.01);
    EXPECT_NEAR(values[curves + 3], 0, 1e-6); // all squares are alike
    EXPECT_NEAR(values[curves + 4], std::log(0.2), 1e-5);
    EXPECT_NEAR(values[curves + 6], -0.5 * std::pow(middle / curve_width, 2), 0.01);
    EXPECT_NEAR(values[curves + 7], std::log(5.0), 1e-6);
}

TEST(StackStatistics, OnlyThePowerFollowsTheLight) {
    const auto once = gaussian_stack(5, 0.1), thrice = gaussian_stack(15, 0.1);
    for (std::size_t k = 0; k + 1 < once.size(); ++k) {
        EXPECT_NEAR(once[k], thrice[k], 1e-3) << k;
    }
    EXPECT_NEAR(thrice.back() - once.back(), std::log(3.0), 1e-6);
    StackStatistics dark({.images = 1, .pixels = ImageSize::square(16), .window = 8, .brightness = false});
    dark.add(0, Grid<float>(16, 16));
    EXPECT_THROW((void)dark.values(), RunError);
}

FreeParameter parameter(const std::string& key, NumberRange range, double start) {
    return {.key = key, .unit = "", .range = range, .start = start};
}

TEST(FreeParameters, AnyPlaceLiesInsideTheRange) {
    const auto between = parameter("a", NumberRange::within(-0.9, 1), 0.5);
    const auto above = parameter("b", NumberRange::at_least(0), 2);
    const auto any = parameter("c", NumberRange::finite(), -4);
    for (const auto& one : {between, above, any}) {
        EXPECT_NEAR(one.value(0), one.start, 1e-12) << one.key;
        for (const double place : {-3.0, 0.0, 2.0}) {
            EXPECT_TRUE(one.range.contains(one.value(place))) << one.key;
            EXPECT_NEAR(one.slope(place), (one.value(place + 1e-5) - one.value(place - 1e-5)) / 2e-5, 1e-6) << one.key;
            EXPECT_GT(one.value(place + 0.1), one.value(place)) << one.key;
        }
    }
    EXPECT_NEAR(above.value(std::log(3.0)), 6, 1e-12);
    EXPECT_NEAR(any.value(1), 0, 1e-12);
    EXPECT_NEAR(between.known_width(0) * between.slope(0), 1.9, 1e-12);
    EXPECT_NEAR(above.known_width(1), std::log(10.0), 1e-12);
    EXPECT_TRUE(std::isinf(any.known_width(0)));
}

// Statistics of 9 images with one contrast that follows the first parameter and a width that follows the second. Noise
// is that of the seed, and neighbours share half of it.
struct Known {
    std::vector<FreeParameter> parameters = {parameter("specimen.material.g", NumberRange::within(-0.9, 1), 0.3),
                                             parameter("specimen.roughness.sq_um", NumberRange::at_least(0), 1)};
    bool alike = false;         // both do nearly the same
    bool without_width = false; // the second does nothing

    std::vector<double> statistics(double g, double sq, unsigned seed) const {
        const StatisticsLayout layout{.images = 9, .pixels = ImageSize::square(8), .window = 8, .brightness = false};
        std::size_t count = 0;
        for (const auto& group : statistic_groups(layout)) {
            count += static_cast<std::size_t>(group.count);
        }
        std::mt19937_64 random(seed);
        std::normal_distribution<double> normal(0, 0.1);
        std::vector<double> values(count);
        double noise = normal(random);
        for (std::size_t k = 0; k < count; ++k) {
            const double z = (static_cast<double>(k % 9) - 4) / 2;
            const double width = without_width || alike ? 1 : sq;
            values[k] = (1 + g + (alike ? std::log(sq) : 0)) * std::exp(-0.5 * z * z / (width * width)) + noise;
            values[k] += alike ? 0.02 * z * std::log(sq) : 0;
            noise = 0.5 * noise + std::sqrt(0.75) * normal(random);
        }
        return values;
    }

    // The fit of a stack with these parameters, whose seed is none of the model's. Fits by the same seeds of the model
    // share its luck.
    Fit fitted(const std::vector<double>& measured, unsigned first_seed = 1, int replicates = 16) const {
        Fit fit{.program = "vkfv", .stack = "stack", .title = "known", .replicates = replicates};
        fit.layout = {.images = 9, .pixels = ImageSize::square(8), .window = 8, .brightness = false};
        for (int image = 0; image < 9; ++image) {
            fit.positions.push_back(1e-3 * image);
        }
        fit.parameters = parameters;
        fit.measured = measured;
        fit.search = search_moments(
            parameters, measured,
            [&](const std::vector<double>& place, int seed) {
                ++fit.stacks;
                return statistics(parameters[0].value(place[0]), parameters[1].value(place[1]),
                                  first_seed + static_cast<unsigned>(seed));
            },
            replicates);
        return fit;
    }
};

TEST(FitSearch, FindsTheParametersFarFromTheStart) {
    const Known known;
    const Fit fit = known.fitted(known.statistics(0.7, 1.8, 100000));
    EXPECT_TRUE(fit.search.settled);
    EXPECT_TRUE(fit.describes());
    EXPECT_EQ(fit.enlargement(), 1);
    EXPECT_LE(fit.stacks, most_stacks(2, 16));
    const auto found = fit.fitted();
    const double truths[] = {0.7, 1.8};
    for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_TRUE(found[k].told) << k;
        EXPECT_NEAR(found[k].estimate, truths[k], 4 * found[k].standard_uncertainty) << k;
        EXPECT_LT(found[k].standard_uncertainty, 0.1) << k;
        EXPECT_LT(found[k].low, found[k].estimate) << k;
        EXPECT_GT(found[k].high, found[k].estimate) << k;
        EXPECT_LT(found[k].uncertainty_ratio, 1.5) << k;
    }
    EXPECT_LT(std::abs(fit.correlation(0, 1)), 0.95);
    EXPECT_NEAR(fit.correlation(0, 1),
                fit.covariance(0, 1) / (found[0].standard_uncertainty * found[1].standard_uncertainty), 1e-12);
    EXPECT_THAT(remarks_of(fit), Not(Contains(HasSubstr("together only"))));
}

// 60 stacks of drawn parameters: of each parameter 57 +- 1.7 intervals are expected to hold.
TEST(FitSearch, IntervalsHoldDrawnParameters) {
    const Known known;
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> draw(0, 1);
    int held[] = {0, 0}, held_of_another = 0;
    for (unsigned stack = 0; stack < 60; ++stack) {
        const double g = 0.2 + 0.5 * draw(random), sq = 0.7 + 0.8 * draw(random);
        const auto found = known.fitted(known.statistics(g, sq, 200000 + stack), 1000 * (stack + 1)).fitted();
        held[0] += found[0].low <= g && g <= found[0].high ? 1 : 0;
        held[1] += found[1].low <= sq && sq <= found[1].high ? 1 : 0;
        held_of_another += found[0].low <= g + 0.2 && g + 0.2 <= found[0].high ? 1 : 0;
    }
    EXPECT_GE(held[0], 51);
    EXPECT_GE(held[1], 51);
    EXPECT_LE(held_of_another, 9);
}

TEST(FitSearch, CorrelatedParametersAreTold) {
    Known known;
    known.alike = true;
    const Fit fit = known.fitted(known.statistics(0.35, 1.02, 100000));
    EXPECT_LT(fit.correlation(0, 1), -0.95);
    EXPECT_THAT(remarks_of(fit), Contains(testing::AllOf(HasSubstr("specimen.material.g and specimen.roughness.sq_um"),
                                                         HasSubstr("together only"))));
}

TEST(FitSearch, AParameterWithoutEffectIsNotTold) {
    Known known;
    known.without_width = true;
    const Fit fit = known.fitted(known.statistics(0.5, 1, 100000));
    const auto found = fit.fitted();
    EXPECT_TRUE(found[0].told);
    EXPECT_FALSE(found[1].determined);
    EXPECT_FALSE(found[1].told);
    EXPECT_TRUE(std::isnan(found[1].estimate));
    EXPECT_THAT(remarks_of(fit), Contains(HasSubstr("does not tell specimen.roughness.sq_um")));
    const auto json = nlohmann::json::parse(json_text(fit_json(fit)));
    EXPECT_TRUE(json.at("parameters").at(1).at("estimate").is_null());
    EXPECT_TRUE(json.at("correlation").at(0).at(1).is_null());
    EXPECT_THAT(fit_page(fit, "[scan]"), HasSubstr("not traceable"));
}

// Nothing is left to estimate where the only free parameter has no effect.
TEST(FitSearch, TheOnlyParameterHasNoEffect) {
    Known known;
    known.without_width = true;
    Fit fit{.program = "vkfv", .stack = "stack", .title = "known", .replicates = 16};
    fit.layout = {.images = 9, .pixels = ImageSize::square(8), .window = 8, .brightness = false};
    fit.parameters = {known.parameters[1]};
    fit.measured = known.statistics(0.3, 1, 100000);
    fit.search = search_moments(
        fit.parameters, fit.measured,
        [&](const std::vector<double>& place, int seed) {
            return known.statistics(0.3, fit.parameters[0].value(place[0]), 1 + static_cast<unsigned>(seed));
        },
        16);
    EXPECT_TRUE(fit.search.settled);
    EXPECT_FALSE(fit.fitted()[0].determined);
    EXPECT_TRUE(std::isfinite(fit.search.fit.misfit));
    EXPECT_THAT(remarks_of(fit), Contains(HasSubstr("held at 1, where the search left it")));
}

TEST(FitSearch, ParametersOfOneAndTheSameEffectAreTold) {
    const Known known;
    Fit fit{.program = "vkfv", .stack = "stack", .title = "known", .replicates = 16};
    fit.layout = {.images = 9, .pixels = ImageSize::square(8), .window = 8, .brightness = false};
    fit.parameters = {parameter("a", NumberRange::at_least(0), 1), parameter("b", NumberRange::at_least(0), 1)};
    fit.measured = known.statistics(0.3, 1.1, 100000);
    fit.search = search_moments(
        fit.parameters, fit.measured,
        [&](const std::vector<double>& place, int seed) {
            return known.statistics(0.3, std::exp(place[0] + place[1]), 1 + static_cast<unsigned>(seed));
        },
        16);
    EXPECT_FALSE(fit.fitted()[0].told);
    EXPECT_FALSE(fit.fitted()[1].told);
    EXPECT_THAT(remarks_of(fit), Contains(HasSubstr("does not tell a and b apart")));
    EXPECT_THAT(remarks_of(fit), Not(Contains(HasSubstr("beyond chance, and it"))));
}

TEST(FitSearch, AModelThatDoesNotDescribeTheStackIsToldAndEnlargesU) {
    const Known known;
    auto measured = known.statistics(0.5, 1.2, 100000);
    for (std::size_t k = 0; k < measured.size(); k += 2) {
        measured[k] += 0.5; // five standard deviations that neither parameter makes
    }
    const Fit fit = known.fitted(measured);
    EXPECT_FALSE(fit.describes());
    EXPECT_GT(fit.enlargement(), 1.5);
    EXPECT_THAT(remarks_of(fit).front(), HasSubstr("does not describe the stack"));
    const auto found = fit.fitted();
    const auto json = fit_json(fit);
    EXPECT_EQ(json.at("model_describes"), false);
    EXPECT_NEAR(found[0].standard_uncertainty / (found[0].bound * found[0].uncertainty_ratio), fit.enlargement(), 1e-9);
    EXPECT_THAT(remarks_of(known.fitted(known.statistics(0.5, 1.2, 100000))).front(),
                HasSubstr("The model describes the stack"));
}

} // namespace of_fit
} // namespace
} // namespace vkfv::measurement
