// Numbers that were counted become the light of pixels: in closed form, and on a device to the host's bits.
#include "trace/device/device_estimate.hpp"
#include "trace/interface/wave_image.hpp"
#include "trace/microscope.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

using namespace vkfv;

namespace {

constexpr ImageSize pixels{37, 23};

estimate::EstimateRule rule_of(std::uint32_t kind, double count) {
    return {.kind = kind, .scale = 3.1e-9, .unit = 1.0 / 4194304, .unit_of_squares = 1.0 / 16777216, .count = count};
}

// Random numbers of all sizes up to 2^62, and a zero.
std::vector<std::uint64_t> random_numbers(std::size_t count) {
    std::mt19937_64 random(5);
    std::vector<std::uint64_t> numbers(count);
    for (auto& number : numbers) {
        number = random() >> (2 + random() % 62);
    }
    numbers.front() = 0;
    return numbers;
}

vulkan::Buffer buffer_of(const vulkan::Device& device, std::span<const std::uint64_t> numbers) {
    vulkan::Buffer buffer(device, numbers.size_bytes());
    buffer.write_values(numbers);
    return buffer;
}

using Estimate = trace::DeviceEstimate;
using trace::MadeBy;

Estimate::Estimated found_by(const vulkan::Device& device, const Estimate& estimate) {
    vulkan::Commands commands(device);
    estimate.record(commands, 1);
    commands.submit_and_wait();
    return estimate.estimated(1);
}

} // namespace

TEST(PixelEstimate, OfCountsIsThatOfSoManyOfTheRays) {
    // With N of n rays the mean is scale N, the variance N (1 - N / n).
    const std::vector<std::uint64_t> counts = {0, 400, 1'000'000};
    const auto light = trace::estimate_pixels(rule_of(estimate::ESTIMATE_COUNTS, 1'000'000), ImageSize{3, 1}, counts);
    EXPECT_EQ(light.flux.values, (std::vector<double>{0, 3.1e-9 * 400, 3.1e-9 * 1'000'000}));
    EXPECT_EQ(light.standard_error.values[0], 0);
    EXPECT_NEAR(light.standard_error.values[1], 3.1e-9 * 20 * std::sqrt(1 - 0.0004), 1e-22);
    EXPECT_EQ(light.standard_error.values[2], 0);
}

TEST(PixelEstimate, OfWeightsIsThatOfRaysWithTheseWeights) {
    // Weights of 1/2, 1/2 and 2 have the sum 3 and the sum of squares 4.5, in their units.
    const std::vector<std::uint64_t> numbers = {3u << 22, 75'497'472};
    const auto light = trace::estimate_pixels(rule_of(estimate::ESTIMATE_WEIGHTS, 90), ImageSize{1, 1}, numbers);
    EXPECT_EQ(light.flux.values[0], 3.1e-9 * 3);
    EXPECT_NEAR(light.standard_error.values[0], 3.1e-9 * std::sqrt(4.5 - 9.0 / 90), 1e-22);
}

TEST(PixelEstimate, OfTwoRandomisationsErrsByHalfOfTheirDifference) {
    const std::vector<std::uint64_t> numbers = {3u << 22, 1, 5u << 22, 9}; // one of padding
    const auto light =
        trace::estimate_pixels(rule_of(estimate::ESTIMATE_RANDOMISATIONS, 2), ImageSize{1, 1}, numbers, 2);
    EXPECT_DOUBLE_EQ(light.flux.values[0], 3.1e-9 * 4);
    EXPECT_DOUBLE_EQ(light.standard_error.values[0], 3.1e-9 * 1);
}

TEST(PixelEstimate, HasTheSameBitsByTheDeviceAndByTheHost) {
    const vulkan::Device device;
    ASSERT_TRUE(device.report().doubles); // else both would be the host's
    struct Case {
        std::uint32_t kind;
        double count;
        std::size_t numbers;
        std::size_t stride;
    };
    const std::size_t count = pixels.count();
    for (const Case& one : {Case{estimate::ESTIMATE_COUNTS, 9.7e18, count, 0},
                            {estimate::ESTIMATE_WEIGHTS, 1e12 / 3, 2 * count, 0},
                            {estimate::ESTIMATE_RANDOMISATIONS, 7, 7 * (count + 13), count + 13}}) {
        const auto rule = rule_of(one.kind, one.count);
        const auto numbers = random_numbers(one.numbers);
        const auto expected = trace::estimate_pixels(rule, pixels, numbers, one.stride);
        const double power = trace::sum_of(expected.flux.values);
        const std::vector<std::uint64_t> further = {3, 1, 4};
        const auto buffer = buffer_of(device, numbers);
        const auto beside = buffer_of(device, further);
        const Estimate::Counted counted{
            .pixels = buffer, .stride = one.stride, .further = &beside, .asks_for_power = true};
        for (const MadeBy by : {MadeBy::device, MadeBy::host}) {
            const Estimate estimate(device, rule, pixels, counted, by);
            const auto found = found_by(device, estimate);
            EXPECT_EQ(found.pixels.flux.values, expected.flux.values) << one.kind;
            EXPECT_EQ(found.pixels.standard_error.values, expected.standard_error.values) << one.kind;
            EXPECT_EQ(found.power, power) << one.kind;
            EXPECT_TRUE(std::ranges::equal(estimate.further(1), further));
        }
        auto twin = rule;
        twin.scale = std::nextafter(rule.scale, 1.0);
        EXPECT_NE(found_by(device, {device, twin, pixels, counted}).pixels.flux.values, expected.flux.values);
    }
}

// The pixels of a large detector need more workgroups than a row of them holds.
TEST(PixelEstimate, ReachesEveryPixelOfALargeDetector) {
    const vulkan::Device device;
    constexpr ImageSize large{3000, 2800};
    std::vector<std::uint64_t> numbers(large.count());
    for (std::size_t pixel = 0; pixel < numbers.size(); pixel += 1009) {
        numbers[pixel] = pixel + 1;
    }
    numbers.back() = 5;
    const auto buffer = buffer_of(device, numbers);
    auto rule = rule_of(estimate::ESTIMATE_COUNTS, 1e15);
    rule.scale = 1;
    const auto found = found_by(device, {device, rule, large, {.pixels = buffer}});
    const std::vector<double> expected(numbers.begin(), numbers.end());
    EXPECT_TRUE(found.pixels.flux.values == expected);
}

TEST(PixelEstimate, OfWavesIsTheirLightWithTheNoiseThatFilteringLeaves) {
    const auto instrument = test::microscope();
    const vulkan::Device device;
    constexpr ImageSize pixels{20, 12}; // sides of small primes: their transforms are made ready soon
    const optics::PupilFilter filter(instrument, {.cells = 2, .parts = 2});
    const auto rule = rule_of(estimate::ESTIMATE_COUNTS, 1e9);
    const auto numbers = buffer_of(device, random_numbers(pixels.count()));
    std::vector<std::uint64_t> light(trace::WaveImage(filter, pixels).numbers());
    for (std::size_t k = 0; k < light.size(); ++k) {
        light[k] = 100 + k % 17;
    }
    const auto given = buffer_of(device, light);
    constexpr double scale = 4e-9;
    const auto rays = found_by(device, {device, rule, pixels, {.pixels = numbers, .asks_for_power = true}});
    const auto expected = trace::with_waves(rays.pixels, trace::WaveImage(filter, pixels).apply(light), scale, filter);
    ASSERT_LT(filter.noise(), 1);

    std::vector<trace::PixelLight> all;
    for (const MadeBy waves_by : {MadeBy::device, MadeBy::host}) {
        const trace::SceneWaves waves(device, filter, pixels, waves_by);
        vulkan::Commands commands(device);
        commands.copy(given, *waves.sorted_light().buffers().front(), given.bytes());
        commands.submit_and_wait();
        if (waves.on_device()) {
            trace::DispatchPace pace(1);
            trace::ExposureWork work(device, pace);
            waves.make_image(work);
            work.wait();
        }
        for (const bool power : {true, false}) {
            const Estimate::Counted counted{
                .pixels = numbers, .waves = &waves, .waves_scale = scale, .asks_for_power = power};
            for (const MadeBy by : {MadeBy::device, MadeBy::host}) {
                const auto found = found_by(device, {device, rule, pixels, counted, by});
                EXPECT_EQ(found.power, power ? rays.power : std::nullopt); // the power that the rays bring
                EXPECT_EQ(found.pixels.standard_error.values, expected.standard_error.values);
                for (std::size_t pixel = 0; pixel < pixels.count(); ++pixel) {
                    // The waves that the device makes are in float.
                    ASSERT_NEAR(found.pixels.flux.values[pixel] / expected.flux.values[pixel], 1,
                                waves.on_device() ? 2e-6 : 0)
                        << pixel;
                }
                all.push_back(found.pixels);
            }
        }
    }
    EXPECT_EQ(all[0].flux.values, all[1].flux.values);
    EXPECT_EQ(all[0].flux.values, all[3].flux.values);
}
