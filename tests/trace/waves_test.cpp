// The image that waves make of light sorted by pupil cells.
#include "optics/airy_pattern.hpp"
#include "optics/ideal_lens.hpp"
#include "trace/device_tracer.hpp"
#include "trace/device_wave_image.hpp"
#include "trace/host_tracer.hpp"
#include "trace/microscope.hpp"
#include "trace/wave_image.hpp"

#include "support/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

using namespace vkfv;

namespace {

std::vector<std::uint64_t> noisy_light(std::size_t numbers, double mean) {
    std::mt19937_64 random(1);
    std::poisson_distribution<std::uint64_t> count(mean);
    std::vector<std::uint64_t> light(numbers);
    std::generate(light.begin(), light.end(), [&] { return count(random); });
    return light;
}

double sum(std::span<const double> values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

double variance(std::span<const double> values) {
    const double mean = sum(values) / static_cast<double>(values.size());
    double squares = 0;
    for (const double value : values) {
        squares += (value - mean) * (value - mean);
    }
    return squares / static_cast<double>(values.size() - 1);
}

// Of the cells' images, all light of a pixel.
Grid<double> unfiltered(std::span<const std::uint64_t> light, int pixels, int parts, int cells) {
    Grid<double> image(pixels, pixels);
    const int side = pixels * parts;
    std::size_t next = 0;
    for (int cell = 0; cell < cells; ++cell) {
        for (int row = 0; row < side; ++row) {
            for (int column = 0; column < side; ++column) {
                image(column / parts, row / parts) += static_cast<double>(light[next++]);
            }
        }
    }
    return image;
}

trace::TraceOptions with_waves(trace::Estimator estimator) {
    trace::TraceOptions options;
    options.estimator = estimator;
    options.rays = estimator == trace::Estimator::forward ? 400000 : 64 * 64 * 32;
    options.seed = 3;
    options.waves.emplace();
    return options;
}

optics::Instrument turned_microscope() {
    auto description = test::microscope_description();
    description.turned = true;
    return optics::assemble(description);
}

} // namespace

TEST(Waves, keep_the_light_and_do_not_add_noise) {
    const auto instrument = test::microscope();
    for (const int parts : {1, 3}) {
        const optics::PupilFilter filter(instrument, {.cells = 8, .parts = parts});
        constexpr int pixels = 21;
        const trace::WaveImage waves(filter, pixels);
        const auto light = noisy_light(waves.numbers(), 30);
        const auto before = unfiltered(light, pixels, parts, filter.cell_count());
        const auto after = waves.apply(light);
        EXPECT_NEAR(sum(after.values) / sum(before.values), 1, 1e-12);
        // The noise that is told, from 441 pixels of it; light of all cells alike is not that of a filled pupil.
        const double noise = std::sqrt(variance(after.values) / variance(before.values));
        EXPECT_NEAR(noise, filter.noise(), 0.12);
        EXPECT_LT(noise, 0.95);
    }
}

TEST(Waves, of_a_single_cell_in_focus_are_the_airy_transfer) {
    // All light in one part of a pixel: its image is the point spread.
    auto description = test::microscope_description();
    description.objective = optics::ideal_objective(20, 0.28);
    description.tube_lens = optics::ideal_lens(200);
    const auto instrument = optics::assemble(description);
    const optics::PupilFilter filter(instrument, {.cells = 8, .parts = 4});
    for (const double s : {0.1, 0.4, 0.7}) {
        std::complex<double> mean = 0;
        for (int cell = 0; cell < filter.cell_count(); ++cell) {
            mean += filter.share(cell) * filter.transfer(cell, s * filter.cutoff(), 0);
        }
        EXPECT_NEAR(mean.real(), optics::circular_pupil_transfer(s, 1), 0.004) << s;
        EXPECT_NEAR(mean.imag(), 0, 1e-6) << s;
    }
}

TEST(Waves, are_the_same_on_the_device_and_on_the_host) {
    const auto instrument = test::microscope();
    const vulkan::Device device;
    // Sizes with other primes than two; light that lies on one side only, to tell left from right.
    for (const auto& [pixels, parts, cells] : {std::tuple{20, 2, 8}, {21, 3, 4}, {7, 5, 2}}) {
        const optics::PupilFilter filter(instrument, {.cells = cells, .parts = parts});
        const trace::WaveImage on_host(filter, pixels);
        auto light = noisy_light(on_host.numbers(), 50);
        for (std::size_t k = 0; k < light.size(); k += 7) {
            light[k] *= 1 + k * 5 / light.size();
        }
        vulkan::Buffer buffer(device, light.size() * sizeof(light.front()));
        buffer.write_values(std::span<const std::uint64_t>(light));
        const trace::DeviceWaveImage on_device(device, filter, pixels, buffer);
        vulkan::Commands commands(device);
        on_device.record(commands);
        commands.submit_and_wait();
        const auto found = on_device.image();
        const auto expected = on_host.apply(light);
        const double mean = sum(expected.values) / static_cast<double>(expected.values.size());
        for (std::size_t pixel = 0; pixel < found.values.size(); ++pixel) {
            ASSERT_NEAR(found.values[pixel], expected.values[pixel], 2e-6 * mean) << pixels << ' ' << pixel;
        }
        EXPECT_NEAR(sum(found.values) / sum(expected.values), 1, 1e-6);
    }
}

TEST(Waves, sort_light_alike_forward_and_backward_on_device_and_host) {
    const auto instrument = turned_microscope();
    const auto specimen = test::rough_specimen();
    constexpr double z = 0.004;
    std::vector<trace::Image> images;
    for (const auto estimator : {trace::Estimator::forward, trace::Estimator::backward}) {
        const auto options = with_waves(estimator);
        images.push_back(trace::make_device_tracer(instrument, specimen, options)->expose(z, 1));
        images.push_back(trace::make_host_tracer(instrument, specimen, options)->expose(z, 1));
        auto rays = options;
        rays.waves.reset();
        const auto of_rays = trace::make_device_tracer(instrument, specimen, rays)->expose(z, 1);
        EXPECT_NEAR(sum(images[images.size() - 2].flux.values) / sum(of_rays.flux.values), 1, 1e-6);
        EXPECT_EQ(images[images.size() - 2].detected, of_rays.detected);
        EXPECT_LT(variance(images.back().flux.values), variance(of_rays.flux.values));
    }
    // Device and host trace the same paths, some of which round to another part of a pixel.
    for (const std::size_t first : {0u, 2u}) {
        const auto& device = images[first].flux.values;
        const auto& host = images[first + 1].flux.values;
        const double mean = sum(host) / static_cast<double>(host.size());
        double squares = 0;
        for (std::size_t pixel = 0; pixel < host.size(); ++pixel) {
            squares += std::pow(device[pixel] - host[pixel], 2) / static_cast<double>(host.size());
        }
        EXPECT_LT(std::sqrt(squares), 0.02 * mean) << first;
    }
    // Forward and backward differ by noise alone.
    double squares = 0;
    double expected = 0;
    for (std::size_t pixel = 0; pixel < images[0].flux.values.size(); ++pixel) {
        squares += std::pow(images[0].flux.values[pixel] - images[2].flux.values[pixel], 2);
        expected +=
            std::pow(images[0].standard_error.values[pixel], 2) + std::pow(images[2].standard_error.values[pixel], 2);
    }
    EXPECT_NEAR(squares / expected, 1, 0.25);
}

TEST(Waves, are_the_same_bits_for_any_batch) {
    const auto instrument = turned_microscope();
    const auto specimen = test::rough_specimen();
    for (const auto estimator : {trace::Estimator::forward, trace::Estimator::backward}) {
        auto options = with_waves(estimator);
        options.rays /= 4;
        const auto whole = trace::make_device_tracer(instrument, specimen, options)->expose(0, 1);
        options.batch = 9000;
        const auto parted = trace::make_device_tracer(instrument, specimen, options)->expose(0, 1);
        EXPECT_EQ(whole.flux.values, parted.flux.values);
    }
}
