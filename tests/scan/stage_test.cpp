// The errors of a stage move positions as closed forms say, and tracers take the moved positions.
#include "scan/staged_tracer.hpp"

#include "core/mathematics/units.hpp"
#include "scan/fake_stack.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <set>
#include <utility>

namespace vkfv::scan {
namespace {

std::vector<double> steps(int images, double step) {
    std::vector<double> positions;
    for (int image = 0; image < images; ++image) {
        positions.push_back(step * (image - images / 2));
    }
    return positions;
}

double deviation(const std::vector<double>& values) {
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    double squares = 0;
    for (const double value : values) {
        squares += (value - mean) * (value - mean);
    }
    return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

std::vector<double> errors(const StageMotion& motion, const std::vector<double>& positions) {
    std::vector<double> result;
    for (std::size_t image = 0; image < positions.size(); ++image) {
        result.push_back(motion.at(positions[image], static_cast<std::uint32_t>(image)).height - positions[image]);
    }
    return result;
}

} // namespace

TEST(Stage, WithoutErrorsIsTrue) {
    const auto positions = steps(21, 0.001);
    Stage stage;
    EXPECT_TRUE(stage.still());
    const StageMotion motion(stage, positions);
    EXPECT_EQ(motion.moments(), 1);
    EXPECT_EQ(motion.farthest(positions), 0);
    EXPECT_EQ(motion.at(positions[3], 3).beside, glm::dvec2(0));
    EXPECT_EQ(motion.reading(positions[3], 3), positions[3]);
    EXPECT_EQ(motion.light(3), 1);
}

// The stage stands where the scale reads the nominal position.
TEST(Stage, StandsWhereItsScaleReadsThePosition) {
    const auto positions = steps(401, 0.0005);
    Stage stage;
    stage.scale_error = 0.01;
    stage.linearity_positions = {-0.05, 0, 0.05};
    stage.linearity_errors = {0.0002, 0, -0.0004};
    stage.periodic_amplitude = 0.0001;
    stage.periodic_period = 0.02;
    stage.periodic_phase = 0.3;
    EXPECT_FALSE(stage.still());
    const StageMotion motion(stage, positions);
    for (std::size_t image = 0; image < positions.size(); ++image) {
        const double nominal = positions[image];
        const double really = motion.at(nominal, static_cast<std::uint32_t>(image)).height;
        const double linearity = nominal <= -0.05  ? 0.0002
                                 : nominal <= 0    ? -0.0002 * nominal / 0.05
                                 : nominal <= 0.05 ? -0.0004 * nominal / 0.05
                                                   : -0.0004;
        const double periodic = 0.0001 * std::sin(2 * pi * nominal / 0.02 + 0.3);
        EXPECT_NEAR(really * 1.01 + linearity + periodic, nominal, 1e-15);
        EXPECT_EQ(motion.reading(nominal, static_cast<std::uint32_t>(image)), nominal);
    }
}

TEST(Stage, JitterIsIndependentAndDoesNotAddUp) {
    const auto positions = steps(4001, 0.0001);
    Stage stage;
    stage.jitter = 0.0003;
    const StageMotion motion(stage, positions);
    const auto found = errors(motion, positions);
    EXPECT_NEAR(deviation(found), 0.0003, 5 * 0.0003 / std::sqrt(2 * 4000.0));
    double neighbours = 0;
    for (std::size_t k = 1; k < found.size(); ++k) {
        neighbours += found[k] * found[k - 1] / (0.0003 * 0.0003 * 4000);
    }
    EXPECT_NEAR(neighbours, 0, 5 / std::sqrt(4000.0));
    stage.seed = 2;
    EXPECT_NE(errors(StageMotion(stage, positions), positions), found);
    // The scale sees the error, and reads it with noise of its own.
    stage.reading_noise = 0.0001;
    const StageMotion read(stage, positions);
    std::vector<double> apart;
    for (std::size_t image = 0; image < positions.size(); ++image) {
        const auto number = static_cast<std::uint32_t>(image);
        apart.push_back(read.reading(positions[image], number) - read.at(positions[image], number).height);
    }
    EXPECT_NEAR(deviation(apart), 0.0001, 5 * 0.0001 / std::sqrt(2 * 4000.0));
}

TEST(Stage, TellsHowFarAstrayImagesBeyondTheScanAreToo) {
    const std::vector<double> scan = {0, 0.001, 0.002};
    const std::vector<double> with_further = {0, 0.001, 0.002, 0.01};
    Stage stage;
    stage.jitter = 0.0003;
    int farther = 0; // seeds with a moment beyond all positions of the scan
    for (stage.seed = 1; stage.seed <= 40; ++stage.seed) {
        const StageMotion motion(stage, scan);
        const double beyond = std::abs(motion.at(with_further[3], 3).height - with_further[3]);
        EXPECT_EQ(motion.farthest(with_further), std::max(motion.farthest(scan), beyond));
        farther += beyond > motion.farthest(scan);
    }
    EXPECT_GT(farther, 0);
}

TEST(Stage, LagsOnTheWayDown) {
    const auto positions = steps(11, 0.001);
    Stage stage;
    stage.backlash = 0.0025;
    EXPECT_EQ(StageMotion(stage, positions).farthest(positions), 0); // upwards there is none
    stage.downwards = true;
    const StageMotion motion(stage, positions);
    const std::vector<double> expected = {0.0025, 0.0025, 0.0025, 0.0025, 0.0025, 0.0025,
                                          0.0025, 0.0025, 0.002,  0.001,  0};
    const auto found = errors(motion, positions);
    for (std::size_t image = 0; image < expected.size(); ++image) {
        EXPECT_NEAR(found[image], expected[image], 1e-15) << image;
    }
}

// Images are taken one after the other, and the focal plane drifts upwards meanwhile.
TEST(Stage, DriftsFromImageToImage) {
    const auto positions = steps(21, 0.001);
    Stage stage;
    stage.drift = 0.0004;
    stage.interval = 0.25;
    for (const bool downwards : {false, true}) {
        stage.downwards = downwards;
        const auto found = errors(StageMotion(stage, positions), positions);
        for (std::size_t image = 0; image < positions.size(); ++image) {
            const std::size_t before = downwards ? positions.size() - 1 - image : image;
            EXPECT_NEAR(found[image], 0.0001 * static_cast<double>(before), 1e-15) << image << ' ' << downwards;
        }
    }
}

// Looked at once an interval, a vibration has its aliased frequency; within an exposure it is averaged.
TEST(Stage, Vibrates) {
    const auto positions = steps(1000, 0.0001);
    Stage stage;
    stage.vibrations = {{.amplitude = 0.0002, .frequency = 52}};
    stage.interval = 0.04; // 2.08 periods: 2 Hz remain
    const StageMotion motion(stage, positions);
    const auto found = errors(motion, positions);
    EXPECT_NEAR(deviation(found), 0.0002 / std::sqrt(2.0), 1e-6);
    const auto amplitude = [&](double frequency) {
        double cosine = 0, sine = 0;
        for (std::size_t k = 0; k < found.size(); ++k) {
            const double turn = 2 * pi * frequency * 0.04 * static_cast<double>(k);
            cosine += found[k] * std::cos(turn) * 2 / 1000;
            sine += found[k] * std::sin(turn) * 2 / 1000;
        }
        return std::hypot(cosine, sine);
    };
    EXPECT_NEAR(amplitude(2), 0.0002, 1e-6);
    EXPECT_NEAR(amplitude(3), 0, 2e-6);
    EXPECT_EQ(motion.moments(), 1);

    stage.exposure_time = 0.5 / 52; // half a period: sinc(1/2) = 2 / pi of the amplitude remains
    stage.moments = 32;
    const StageMotion blurring(stage, positions);
    EXPECT_EQ(blurring.moments(), 32);
    std::vector<double> means;
    for (std::size_t image = 0; image < positions.size(); ++image) {
        means.push_back(blurring.mean(positions[image], static_cast<std::uint32_t>(image)).height - positions[image]);
    }
    EXPECT_NEAR(deviation(means), 0.0002 / std::sqrt(2.0) * 2 / pi, 2e-6);
}

// The mean square is the spectrum's integral, and the power below 40 Hz the integral to there: of a flat band of 10 to
// 20 Hz, and of a triangle over 60 to 80 Hz, of which a quarter lies below 70 Hz. The mean square of a band B that is
// looked at for T seconds is known to 1 / sqrt(B T) of it: the bounds are four times that, of four seeds together.
TEST(Stage, VibratesByASpectrum) {
    constexpr int images = 8192, seeds = 4;
    constexpr double interval = 0.005; // 41 s, up to 100 Hz
    const auto positions = steps(images, 0.0001);
    Stage stage;
    stage.interval = interval;
    stage.vibration_frequencies = {10, 20, 20.001, 60, 80};
    stage.vibration_densities = {2e-9, 2e-9, 0, 0, 4e-9};
    EXPECT_FALSE(stage.still());
    // The power is found by the algorithm of G. Goertzel, Am. Math. Monthly 65 (1958) 34.
    const auto power_below = [&](const std::vector<double>& found, double limit) {
        double power = 0;
        for (int bin = 1; bin / (images * interval) < limit; ++bin) {
            const double twice_cosine = 2 * std::cos(2 * pi * bin / images);
            double before = 0, last = 0;
            for (const double value : found) {
                before = std::exchange(last, value + twice_cosine * last - before);
            }
            power += 2 * (last * last + before * before - twice_cosine * last * before) / images / images;
        }
        return power;
    };
    const double low = 2e-8, high = 0.5 * 20 * 4e-9;
    double total = 0, below_40 = 0, below_70 = 0;
    for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
        stage.seed = seed;
        const auto found = errors(StageMotion(stage, positions), positions);
        total += std::pow(deviation(found), 2) / seeds;
        below_40 += power_below(found, 40) / seeds;
        below_70 += power_below(found, 70) / seeds;
    }
    EXPECT_NEAR(total / (low + high), 1, 0.07);
    EXPECT_NEAR(below_40 / low, 1, 0.1);
    EXPECT_NEAR((below_70 - below_40) / high, 0.25, 0.03);
    Stage other = stage; // wrong twin: half of the power that the flat part has
    other.vibration_densities = {0, 2e-9, 0, 0, 4e-9};
    EXPECT_LT(power_below(errors(StageMotion(other, positions), positions), 40) / low, 0.7);
}

TEST(Stage, MovesTheSpecimenAside) {
    const auto positions = steps(11, 0.1);
    Stage stage;
    stage.lateral_drift = {0.001, 0};
    stage.tilt = {0, 0.02};
    stage.interval = 2;
    const StageMotion motion(stage, positions);
    EXPECT_NEAR(motion.at(positions[7], 7).beside.x, 0.014, 1e-15);
    EXPECT_NEAR(motion.at(positions[7], 7).beside.y, 0.02 * positions[7], 1e-15);
    stage = Stage();
    stage.runout = 0.003;
    stage.runout_period = 0.4;
    const StageMotion round(stage, positions);
    EXPECT_NEAR(glm::length(round.at(positions[8], 8).beside), 0.003, 1e-15);
    EXPECT_NEAR(glm::length(round.at(positions[6], 6).beside + round.at(positions[8], 8).beside), 0, 1e-15);
}

TEST(StagedTracer, ExposesWhereTheStageStands) {
    const auto positions = steps(21, 0.001);
    Stage stage;
    stage.jitter = 0.0002;
    stage.light_noise = 0.1;
    const StageMotion motion(stage, positions);
    const auto staged = make_staged_tracer(std::make_unique<test::FakeTracer>(), motion);
    std::vector<double> light;
    for (std::uint32_t image = 0; image < positions.size(); ++image) {
        const auto exposed = staged->expose(positions[image], image);
        const double really = motion.at(positions[image], image).height;
        light.push_back(motion.light(image));
        EXPECT_NEAR(exposed.flux(2, 1), light.back() * test::flux(2, 1, really, image, 1), 1e-12);
        EXPECT_NEAR(exposed.ledger.residual(), 0, 1e-12);
    }
    EXPECT_NEAR(deviation(light), 0.1, 0.06);
}

// An image is the mean over the moments of an exposure, each with random numbers of its own.
TEST(StagedTracer, AveragesOverTheMomentsOfAnExposure) {
    const auto positions = steps(21, 0.001);
    Stage stage;
    stage.vibrations = {{.amplitude = 0.002, .frequency = 90}, {.amplitude = 0.001, .frequency = 31}};
    stage.exposure_time = 0.05;
    stage.moments = 5;
    const StageMotion motion(stage, positions);
    auto fake = std::make_unique<test::FakeTracer>();
    const auto& asked = fake->exposed;
    const auto staged = make_staged_tracer(std::move(fake), motion);
    const auto exposed = staged->expose(positions[4], 4);
    ASSERT_EQ(asked.size(), 5u);
    double expected = 0;
    for (int moment = 0; moment < 5; ++moment) {
        expected += test::flux(2, 1, motion.at(positions[4], 4, moment).height,
                               static_cast<std::uint32_t>(asked[static_cast<std::size_t>(moment)]), 1) /
                    5;
    }
    EXPECT_NEAR(exposed.flux(2, 1), expected, 1e-12);
    EXPECT_EQ(exposed.rays, 5 * test::rays);
    EXPECT_EQ(std::set<int>(asked.begin(), asked.end()).size(), 5u);
    EXPECT_NEAR(exposed.ledger.residual(), 0, 1e-12);
}

} // namespace vkfv::scan
