// Images of waves are made by filters of several points of the field.
#include "core/mathematics/units.hpp"
#include "optics/waves/point_waves.hpp"
#include "trace/interface/wave_image.hpp"
#include "trace/microscope.hpp"
#include "trace/noisy_light.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <random>
#include <vector>

using namespace vkfv;

namespace {

double sum(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

double variance(const std::vector<double>& values) {
    const double mean = sum(values) / static_cast<double>(values.size());
    double squares = 0;
    for (const double value : values) {
        squares += (value - mean) * (value - mean);
    }
    return squares / static_cast<double>(values.size() - 1);
}

// An ideal microscope with pixels of an eighth of the shortest wave that it passes.
optics::Instrument ideal_microscope() {
    auto description = test::ideal_microscope_description();
    constexpr double wavelength = 0.55e-3, aperture = 0.28;
    description.spectrum = optics::Spectrum::line(wavelength * um_per_mm);
    description.detector_pixels = ImageSize::square(32);
    description.detector_width = 32 * wavelength / (8 * aperture) * 10;
    return optics::assemble(description);
}

} // namespace

// If all tiles have one filter, the image in windows is that of the whole: no seam shows. The field is taken for so
// small that the wavefronts do not differ; the light has steps from pixel to pixel, as large as itself.
TEST(WavesOfTheField, InWindowsAreThoseOfTheWholeImage) {
    auto instrument = ideal_microscope();
    instrument.first_order.field_corner *= 1e-6;
    instrument.first_order.pixel_pitch *= 2; // parts of an eighth of the shortest wave: one a pixel
    ASSERT_EQ(optics::parts_for_waves(instrument), 1);
    const ImageSize pixels{300, 220};
    const optics::PupilFilter whole(instrument, {.cells = 2, .parts = 1, .tiles = 1});
    const optics::PupilFilter tiled(instrument, {.cells = 2, .parts = 1, .tiles = 5});
    const trace::WaveImage image(whole, pixels);
    const auto light = test::noisy_light(image.numbers(), 5);
    const auto expected = image.apply(light);
    const auto found = trace::WaveImage(tiled, pixels).apply(light);
    const double mean = sum(expected.values) / static_cast<double>(expected.values.size());
    double largest = 0, squares = 0;
    for (std::size_t pixel = 0; pixel < found.values.size(); ++pixel) {
        const double difference = (found.values[pixel] - expected.values[pixel]) / mean;
        largest = std::max(largest, std::abs(difference));
        squares += difference * difference / static_cast<double>(found.values.size());
    }
    const double noise = std::sqrt(variance(expected.values)) / mean;
    EXPECT_LT(largest, 0.1 * noise);
    EXPECT_LT(std::sqrt(squares), 0.01 * noise);
    EXPECT_NEAR(sum(found.values) / sum(expected.values), 1, 1e-4);
}

// Each point of the field has the transfer function of its own wavefront. A spot shines in an image of 0.4 mm, as wide
// as the sum of four numbers that are even over a pixel; its rays land where the wavefront's slope takes them. The
// spectrum of its image is Hopkins' integral (PointWaves::transfer()) times the fifth power of a pixel's, of the spot
// and of the pixels that it is counted in; what these alias is below 0.01.
TEST(WavesOfTheField, HaveTheTransferOfTheirOwnPoints) {
    auto description = test::microscope_description();
    constexpr int side = 400;
    description.detector_pixels = ImageSize::square(side);
    description.detector_width = 4;
    description.field_stop_radius = 4.3;
    const auto instrument = optics::assemble(description);
    const double pitch = instrument.first_order.pixel_pitch;
    const optics::PupilFilter tiled(instrument, {.cells = 6, .parts = 1, .tiles = 5});
    const optics::PupilFilter axis(instrument, {.cells = 6, .parts = 1, .tiles = 1});
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> even(0, 1);
    {
        constexpr int at_column = 370, at_row = 310; // apart from its mirror images
        const glm::dvec2 field = pitch * (glm::dvec2(at_column, at_row) + 0.5 - 0.5 * side);
        const auto point = optics::PointWaves(instrument, field, 1).at_height(0.004);
        const optics::Wavefront& wavefront = point.middle();
        const trace::WaveImage image(tiled, ImageSize::square(side));
        std::vector<std::uint64_t> light(image.numbers());
        const glm::dvec2 slope =
            wavefront.chief_slope() - physics::f64::chief_slope(tiled.cells(), wavefront.detector_point());
        constexpr int rays = 300000;
        std::uint64_t all = 0;
        for (int ray = 0; ray < rays; ++ray) {
            const glm::dvec2 p =
                wavefront.chief() + wavefront.largest_rim() * (2.0 * glm::dvec2(even(random), even(random)) - 1.0);
            glm::dvec2 spot(-2);
            for (int k = 0; k < 4; ++k) {
                spot += glm::dvec2(even(random), even(random));
            }
            if (!wavefront.passes(p)) {
                continue;
            }
            const glm::dvec2 place = glm::dvec2(at_column, at_row) + 0.5 + spot + wavefront.displacement(p) / pitch;
            const auto cell =
                static_cast<std::size_t>(physics::f64::pupil_cell(tiled.cells(), wavefront.image_slope(p) + slope));
            light[cell * image.numbers_a_cell() + static_cast<std::size_t>(std::floor(place.y)) * side +
                  static_cast<std::size_t>(std::floor(place.x))] += 1;
            ++all;
        }
        const auto transfer_of = [&](const Grid<double>& pixels, glm::dvec2 frequency) {
            std::complex<double> sum = 0;
            for (int row = 0; row < side; ++row) {
                for (int column = 0; column < side; ++column) {
                    const glm::dvec2 from = pitch * glm::dvec2(column - at_column, row - at_row);
                    sum += pixels(column, row) * std::polar(1.0, -2 * pi * glm::dot(frequency, from));
                }
            }
            return sum / static_cast<double>(all);
        };
        const auto of_field = image.apply(light);
        const auto of_axis = trace::WaveImage(axis, ImageSize::square(side)).apply(light);
        // An Airy pattern has 2 / (pi v) of its light beyond v = 2 pi NA r / wavelength: 0.0045 beyond the 48 pixels
        // that a window reaches into the next ones, of which this corner of it loses less than a half.
        EXPECT_NEAR(sum(of_field.values) / static_cast<double>(all), 1, 0.0023);
        double worst = 0, worst_of_axis = 0;
        for (const glm::dvec2 share : {glm::dvec2(0.4, 0), {0, 0.4}, {0.28, 0.28}, {0.28, -0.28}}) {
            const glm::dvec2 frequency = share * tiled.cutoff();
            const auto spread = [](double turns) {
                return turns == 0 ? 1.0 : std::pow(std::sin(pi * turns) / (pi * turns), 5);
            };
            const auto expected = point.transfer(frequency) * spread(pitch * frequency.x) * spread(pitch * frequency.y);
            worst = std::max(worst, std::abs(transfer_of(of_field, frequency) - expected));
            worst_of_axis = std::max(worst_of_axis, std::abs(transfer_of(of_axis, frequency) - expected));
        }
        EXPECT_LT(worst, 0.016) << at_column; // six cells, noise and what is aliased
        EXPECT_GT(worst_of_axis, 1.4 * worst) << at_column;
    }
}
