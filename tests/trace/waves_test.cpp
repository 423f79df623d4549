// Waves make images of light sorted by pupil cells with the contrast of the scalar Debye integral.
#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"
#include "optics/prescriptions/ideal_lens.hpp"
#include "optics/waves/airy_pattern.hpp"
#include "trace/device/device_tracer.hpp"
#include "trace/device/device_wave_image.hpp"
#include "trace/device/sorted_light.hpp"
#include "trace/device/wave_memory.hpp"
#include "trace/host/host_tracer.hpp"
#include "trace/interface/wave_image.hpp"
#include "trace/interface/wave_windows.hpp"
#include "trace/microscope.hpp"
#include "trace/noisy_light.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <future>
#include <numeric>
#include <vector>

using namespace vkfv;

namespace {

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

// The sum of the cells' images: all light of each pixel.
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

std::vector<float> made_by_device(const vulkan::Device& device, const optics::PupilFilter& filter, ImageSize pixels,
                                  const trace::SortedLight& light) {
    const trace::DeviceWaveImage image(device, filter, pixels, light);
    vulkan::Commands commands(device);
    image.record(commands);
    commands.submit_and_wait();
    return image.light_of_pixels().read_values<float>(pixels.count());
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

// The contrast H at s of the cutoff (scalar Debye integral) with the object z mm from focus: a sum over the overlap of
// two pupils.
double debye_transfer(double aperture, double wavelength, double s, double z) {
    constexpr int half = 300;
    const double k = 2 * pi / wavelength;
    double sum = 0;
    double area = 0;
    for (int j = -half; j < half; ++j) {
        for (int i = -half; i < half; ++i) {
            const double x = aperture * (i + 0.5) / half;
            const double y = aperture * (j + 0.5) / half;
            const double ahead = std::pow(x + s * aperture, 2) + y * y;
            const double behind = std::pow(x - s * aperture, 2) + y * y;
            area += x * x + y * y <= aperture * aperture ? 1 : 0;
            if (std::max(ahead, behind) <= aperture * aperture) {
                sum += std::cos(k * z * (std::sqrt(1 - ahead) - std::sqrt(1 - behind)));
            }
        }
    }
    return sum / area;
}

constexpr double grating_wavelength = 0.55e-3;
constexpr int grating_pixels = 32;

// An ideal lens with pixels of an eighth of the shortest wave that it passes; `tilt` is that of the detector in rad.
optics::InstrumentDescription ideal_description(double aperture, double tilt = 0) {
    auto description = test::ideal_microscope_description();
    const double focal_length = aperture > 0.5 ? 4 : 20;
    description.spectrum = optics::Spectrum::line(grating_wavelength * um_per_mm);
    description.source.radius = 0.5;
    description.objective = optics::ideal_objective(focal_length, aperture);
    description.detector_pixels = ImageSize::square(grating_pixels);
    description.detector_width = grating_pixels * grating_wavelength / (8 * aperture) * 200 / focal_length;
    description.field_stop_radius = 0.1;
    description.detector_placement.change.tilt_y = tilt;
    description.turned = true;
    return description;
}
optics::Instrument ideal_microscope(double aperture, double tilt = 0) {
    return optics::assemble(ideal_description(aperture, tilt));
}

// A level Lambertian flat with a grating of reflectance, `period` in mm and `angle` in rad.
specimen::Specimen flat_with_grating(double period, double angle) {
    specimen::Analytic plane;
    plane.x_min = plane.y_min = -0.1;
    plane.x_max = plane.y_max = 0.1;
    specimen::Specimen specimen{plane, specimen::Material{{{"lambertian", 1, {}}}}};
    specimen.reflectance = specimen::make_reflectance_map(
        {.kind = specimen::Reflectance::Kind::grating, .angle = angle, .period = period}, {-0.1, -0.1, 0.1, 0.1}, {});
    return specimen;
}

// The amplitude of a grating at this angle over its mean, in phase with it, without the pixels' own transfer.
double grating_contrast(const Grid<double>& image, double period, double angle, double pitch) {
    double mean = 0;
    double amplitude = 0;
    double square = 0;
    double weights = 0;
    for (int pass = 0; pass < 2; ++pass) {
        for (int row = 0; row < image.rows; ++row) {
            for (int column = 0; column < image.columns; ++column) {
                const double x = (column - 0.5 * (image.columns - 1)) * pitch;
                const double y = (row - 0.5 * (image.rows - 1)) * pitch;
                const double wave = std::cos(2 * pi / period * (x * std::cos(angle) + y * std::sin(angle)));
                const double weight = std::pow(std::sin(pi * (column + 0.5) / image.columns), 2) *
                                      std::pow(std::sin(pi * (row + 0.5) / image.rows), 2);
                if (pass == 0) {
                    weights += weight;
                    mean += weight * image(column, row);
                } else {
                    amplitude += weight * wave * (image(column, row) - mean / weights);
                    square += weight * wave * wave;
                }
            }
        }
    }
    const auto pixel = [&](double cosine) {
        const double turn = pi * pitch * cosine / period;
        return std::abs(turn) < 1e-12 ? 1.0 : std::sin(turn) / turn;
    };
    return amplitude / square / (mean / weights) / (pixel(std::cos(angle)) * pixel(std::sin(angle)));
}

} // namespace

TEST(Waves, GiveGratingsTheContrastOfTheDebyeIntegral) {
    constexpr double angle = 0.39; // rad, between a cell's side and its diagonal
    for (const double aperture : {0.28, 0.83}) {
        const auto instrument = ideal_microscope(aperture);
        const double pitch = instrument.first_order.pixel_pitch;
        for (const double s : {0.25, 0.5}) {
            const double period = grating_wavelength / (2 * aperture * s);
            const auto specimen = flat_with_grating(period, angle);
            auto options = with_waves(trace::Estimator::backward);
            options.rays = 128 * grating_pixels * grating_pixels;
            options.max_bounces = 1;
            const auto tracer = trace::make_device_tracer(instrument, specimen, options);
            for (const double waves : {0.0, 0.25}) {
                const double z = 2 * waves * grating_wavelength / (aperture * aperture);
                const auto image = tracer->expose(z, 1);
                const double expected = debye_transfer(aperture, grating_wavelength, s, z);
                EXPECT_NEAR(grating_contrast(image.flux, period, angle, pitch), expected, waves == 0 ? 0.015 : 0.045)
                    << aperture << ' ' << s << ' ' << waves;
                if (s == 0.5 && waves > 0) {
                    // The wrong twins are rays, and the Airy transfer of focus at this height too.
                    options.waves.reset();
                    const auto rays = trace::make_device_tracer(instrument, specimen, options)->expose(z, 1);
                    const double blurred =
                        grating_contrast(rays.flux, period, angle, pitch) * optics::circular_pupil_transfer(s, 1);
                    EXPECT_GT(std::abs(blurred - expected), 0.15);
                }
            }
        }
    }
}

// A detector that stands askew sees the whole pupil from aside: by 5 degrees, three times the pupil's own half width.
TEST(Waves, FollowADetectorThatIsTilted) {
    constexpr double aperture = 0.28, s = 0.5, waves = 0.25, angle = 0.39, degrees = 5;
    const auto instrument = ideal_microscope(aperture, degrees * pi / 180);
    const double period = grating_wavelength / (2 * aperture * s);
    const auto specimen = flat_with_grating(period, angle);
    const double z = 2 * waves * grating_wavelength / (aperture * aperture);
    const double expected = debye_transfer(aperture, grating_wavelength, s, z);
    for (const auto estimator : {trace::Estimator::forward, trace::Estimator::backward}) {
        auto options = with_waves(estimator);
        options.rays = (estimator == trace::Estimator::forward ? 4096 : 128) * grating_pixels * grating_pixels;
        options.max_bounces = 1;
        const auto image = trace::make_device_tracer(instrument, specimen, options)->expose(z, 1);
        EXPECT_NEAR(grating_contrast(image.flux, period, angle, instrument.first_order.pixel_pitch), expected, 0.05)
            << static_cast<int>(estimator);
    }
}

// tests/references/wavefront_reference.py, transfer(), gives the contrast H on the axis of the 10x for waves of 2.5 um,
// of a flat below, at and above best focus. By rays alone it is 0.29, 0.69, 0.29.
TEST(Waves, GiveGratingsTheContrastOfAnAberratedObjective) {
    auto description = test::microscope_description();
    constexpr double period = 2.5e-3;
    description.detector_pixels = ImageSize::square(grating_pixels);
    description.detector_width = grating_pixels * period / 8 * 9.999284;
    description.turned = true;
    const auto instrument = optics::assemble(description);
    const auto specimen = flat_with_grating(period, 0);
    auto options = with_waves(trace::Estimator::backward);
    options.rays = 128 * grating_pixels * grating_pixels;
    options.max_bounces = 1;
    const auto tracer = trace::make_device_tracer(instrument, specimen, options);
    for (const auto& [height, expected] : {std::pair{-0.004588, 0.2890}, {0.0, 0.4717}, {0.004588, 0.3109}}) {
        const auto image = tracer->expose(-height, 1);
        EXPECT_NEAR(grating_contrast(image.flux, period, 0, instrument.first_order.pixel_pitch), expected, 0.03)
            << height;
    }
}

TEST(Waves, TakeFewerPartsWhereTheDeviceCannotHoldThem) {
    const auto instrument = ideal_microscope(0.28);
    auto coarse = instrument;
    coarse.first_order.pixel_pitch *= 6; // parts of an eighth of the shortest wave: three a pixel
    ASSERT_EQ(optics::parts_for_waves(coarse), 3);
    vulkan::DeviceReport device;
    device.name = "small";
    device.memory_bytes = device.max_allocation_bytes = device.max_storage_buffer_bytes = std::uint64_t{1} << 40;
    const auto parts = [&](const optics::WaveOptions& options) {
        return trace::waves_on_device(options, coarse, device).parts;
    };
    EXPECT_EQ(parts({}), 3);
    EXPECT_EQ(trace::waves_on_device({}, coarse, device).cells, 8);
    EXPECT_EQ(trace::waves_on_device({.cells = 10}, coarse, device).cells, 10);
    // A cell and part takes 8 bytes: 64 x 32^2 x 3^2 cells.
    const auto memory =
        trace::wave_memory({.cells = 8, .parts = 3, .tiles = 1, .pixels = ImageSize::square(grating_pixels)});
    EXPECT_EQ(memory.light, 8u * 64 * 32 * 32 * 9);
    EXPECT_EQ(parts({.most_memory = memory.all()}), 3);
    EXPECT_EQ(parts({.most_memory = memory.all() - 1}), 2);
    // The cells' images lie in as many buffers as they need, 128 bytes less than an allocation each. The light that is
    // transformed at once must fit in one, the image with its mirror images: 8 bytes for each of four times the parts.
    const std::uint64_t image = 4 * memory.light / 64;
    device.max_allocation_bytes = image + 128;
    EXPECT_EQ(parts({}), 3);
    device.max_allocation_bytes = image + 127;
    EXPECT_EQ(parts({}), 2);
    // Parts that are asked for are not changed behind the asker's back.
    EXPECT_THROW(parts({.parts = 3}), InputError);
    EXPECT_EQ(parts({.parts = 2}), 2);
    device.memory_bytes = 1000;
    EXPECT_THROW(parts({}), InputError);
}

// The device has limits as lavapipe's. Light that the host transforms is given to no kernel: 800 x 800 pixels needed
// 164 MB in one binding of 134 MB, and 2448 x 2048 pixels need 2.6 GB of light, which is more than one allocation
// gives.
TEST(Waves, OfManyPixelsFitWhereTheyAreTiled) {
    auto instrument = ideal_microscope(0.28);
    vulkan::DeviceReport device;
    device.name = "small";
    device.type = "CPU";
    device.memory_bytes = std::uint64_t{24} << 30;
    device.max_allocation_bytes = std::uint64_t{1} << 31;
    device.max_storage_buffer_bytes = std::uint64_t{1} << 27;
    const auto fitted = [&](ImageSize pixels, const optics::WaveOptions& options) {
        instrument.constants.detector_columns = pixels.columns;
        instrument.constants.detector_rows = pixels.rows;
        return trace::waves_on_device(options, instrument, device).parts;
    };
    constexpr ImageSize square{800, 800}, camera{2448, 2048};
    EXPECT_EQ(fitted(square, {.cells = 8, .parts = 2}), 2);
    EXPECT_EQ(fitted(camera, {.cells = 8, .parts = 1}), 1);
    // A GPU of the same limits transforms fewer planes at a time; the image with its mirror images, 32 bytes a part,
    // must fit in a binding: 82 MB do, 160 MB do not.
    device.type = "discrete GPU";
    EXPECT_EQ(fitted({1600, 1600}, {.cells = 8, .parts = 1}), 1);
    const auto refused = [&](ImageSize pixels, const optics::WaveOptions& options) -> std::string {
        try {
            fitted(pixels, options);
        } catch (const InputError& error) {
            return error.what();
        }
        return "nothing";
    };
    using testing::HasSubstr;
    EXPECT_THAT(refused(camera, {.cells = 8, .parts = 1}),
                AllOf(HasSubstr("160432128 bytes for the transform"), HasSubstr("at most 134217728 bytes")));
    // Each message names the limit that is violated.
    device.type = "CPU";
    EXPECT_THAT(refused(camera, {.cells = 8, .parts = 1, .most_memory = std::uint64_t{1} << 31}),
                AllOf(HasSubstr("2566914048 bytes of light"), HasSubstr("at most 2147483648 bytes in all, by "
                                                                        "diffraction.most_memory_gib")));
    device.memory_bytes = std::uint64_t{1} << 30; // four fifths of it may hold waves
    EXPECT_THAT(refused(camera, {.cells = 8, .parts = 1}),
                AllOf(HasSubstr("at most 858993459 bytes in all"), HasSubstr("of the memory of small")));
    device.memory_bytes = std::uint64_t{24} << 30;
    device.max_allocation_bytes = 40'000'000; // one cell's image takes 8 x 2448 x 2048
    EXPECT_THAT(refused(camera, {.cells = 8, .parts = 1}),
                AllOf(HasSubstr("40108032 bytes of light for each cell"), HasSubstr("largest allocation of small")));
}

// Windows of one size lie within the image, and their filters' weights add up to 1 at every pixel; one tile is the
// whole image.
TEST(Waves, WindowsOfTheFieldCountEveryPixelOnce) {
    for (const auto& [tiles, pixels, parts] : {std::tuple{1, ImageSize{20, 12}, 2},
                                               {3, ImageSize{320, 200}, 1},
                                               {5, ImageSize{701, 400}, 2},
                                               {9, ImageSize{64, 64}, 4}}) {
        const auto windows = trace::wave_windows(tiles, pixels, parts);
        ASSERT_EQ(windows.size(), tiles == 1 ? 1u : static_cast<std::size_t>((tiles - 1) * (tiles - 1)));
        Grid<double> sums(pixels.columns, pixels.rows);
        for (const trace::WaveWindow& window : windows) {
            ASSERT_EQ(window.size, windows.front().size);
            ASSERT_GE(std::min(window.column, window.row), 0);
            ASSERT_LE(window.column + window.size.columns, pixels.columns);
            ASSERT_LE(window.row + window.size.rows, pixels.rows);
            for (int row = 0; row < pixels.rows; ++row) {
                for (int column = 0; column < pixels.columns; ++column) {
                    const auto weights = trace::weights_at(window, column, row);
                    const double weight = std::accumulate(weights.begin(), weights.end(), 0.0);
                    const bool inside = column >= window.column && column < window.column + window.size.columns &&
                                        row >= window.row && row < window.row + window.size.rows;
                    ASSERT_GE(*std::ranges::min_element(weights), 0);
                    ASSERT_TRUE(inside || weight == 0) << column << ' ' << row;
                    sums(column, row) += weight;
                }
            }
        }
        for (const double sum_of_weights : sums.values) {
            ASSERT_NEAR(sum_of_weights, 1, 1e-12);
        }
    }
}

// The way in which light is sorted is known before a tracer is made, and is that of the tracer's filter.
TEST(Waves, AreToldApartByHowTheirLightIsSorted) {
    const auto instrument = turned_microscope();
    const auto specimen = test::rough_specimen();
    for (const auto estimator : {trace::Estimator::forward, trace::Estimator::backward}) {
        for (const std::string device : {"", "host"}) {
            std::string identity;
            for (const int cells : {0, 6}) {
                auto options = with_waves(estimator);
                options.device = device;
                options.waves->cells = cells;
                const auto tracer = device == "host" ? trace::make_host_tracer(instrument, specimen, options)
                                                     : trace::make_device_tracer(instrument, specimen, options);
                EXPECT_NE(tracer->identity().toml(), identity);
                identity = tracer->identity().toml();
                EXPECT_EQ(identity, trace::expected_identity(instrument, specimen, options).toml());
                EXPECT_EQ(tracer->pupil_filters().front().cells().side, cells == 0 ? 8u : 6u);
                EXPECT_NE(identity.find(cells == 0 ? "\npupil_cells = 8\n" : "\npupil_cells = 6\n"), std::string::npos);
            }
        }
    }
}

TEST(Waves, KeepTheLightAndDoNotAddNoise) {
    const auto instrument = test::microscope();
    for (const int parts : {1, 3}) {
        const optics::PupilFilter filter(instrument, {.cells = 8, .parts = parts});
        constexpr int pixels = 21;
        const trace::WaveImage waves(filter, ImageSize::square(pixels));
        const auto light = test::noisy_light(waves.numbers(), 30);
        const auto before = unfiltered(light, pixels, parts, filter.cell_count());
        const auto after = waves.apply(light);
        EXPECT_NEAR(sum(after.values) / sum(before.values), 1, 1e-12);
        // The noise that is told is seen in 441 pixels; light of all cells alike is not that of a filled pupil.
        const double noise = std::sqrt(variance(after.values) / variance(before.values));
        EXPECT_NEAR(noise, filter.noise(), 0.12);
        EXPECT_LT(noise, 0.95);
    }
}

// A grating lies along either side of a rectangle, and only a part of each pixel takes light.
TEST(Waves, OfRectangularDetectorsWithGaps) {
    constexpr double aperture = 0.28, s = 0.5;
    constexpr double period = grating_wavelength / (2 * aperture * s);
    auto description = ideal_description(aperture);
    description.detector_pixels = {40, 24};
    description.detector_width *= 2 * 40.0 / grating_pixels;
    std::vector<double> light;
    for (const double fill : {1.0, 0.3}) {
        description.fill_factor = fill;
        const auto instrument = optics::assemble(description);
        const double pitch = instrument.first_order.pixel_pitch;
        for (const double angle : {0.0, 0.5 * pi}) {
            auto options = with_waves(trace::Estimator::backward);
            options.rays = 256 * 40 * 24;
            options.max_bounces = 1;
            options.waves->parts = 5; // the gap covers some parts whole and some in part
            const auto image =
                trace::make_device_tracer(instrument, flat_with_grating(period, angle), options)->expose(0, 1);
            ASSERT_EQ(image.flux.columns, 40);
            ASSERT_EQ(image.flux.rows, 24);
            light.push_back(sum(image.flux.values));
            // The contrast is told without the transfer of whole pixels; sensitive ones are narrower.
            const auto sinc = [&](double side) { return std::sin(pi * side / period) / (pi * side / period); };
            const double expected =
                debye_transfer(aperture, grating_wavelength, s, 0) * sinc(std::sqrt(fill) * pitch) / sinc(pitch);
            EXPECT_NEAR(grating_contrast(image.flux, period, angle, pitch), expected, 0.02) << angle;
        }
    }
    EXPECT_NEAR(light[2] / light[0], 0.3, 0.003);
}

TEST(Waves, OfASingleCellInFocusAreTheAiryTransfer) {
    // In focus the cells' transfer functions, weighted by their shares, add up to that of a circular pupil.
    const auto instrument = optics::assemble(test::ideal_microscope_description());
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

TEST(Waves, AreTheSameOnTheDeviceAndOnTheHost) {
    const auto instrument = test::microscope();
    const vulkan::Device device;
    // Sizes have other primes than two; light is stronger on one side, to tell left from right. The last case has
    // several filters over the field, in two windows.
    for (const auto& [pixels, parts, cells, tiles] : {std::tuple{ImageSize{20, 20}, 2, 8, 1},
                                                      {ImageSize{7, 7}, 5, 2, 1},
                                                      {ImageSize{11, 6}, 3, 2, 1},
                                                      {ImageSize{240, 8}, 1, 2, 3}}) {
        const optics::PupilFilter filter(instrument, {.cells = cells, .parts = parts, .tiles = tiles});
        const trace::WaveImage on_host(filter, pixels);
        auto light = test::noisy_light(on_host.numbers(), 50);
        for (std::size_t k = 0; k < light.size(); k += 7) {
            light[k] *= 1 + k * 5 / light.size();
        }
        const auto cell_count = static_cast<std::size_t>(filter.cell_count());
        trace::SortedLight sorted(device, cell_count, on_host.numbers_a_cell());
        sorted.write(light);
        const auto values = made_by_device(device, filter, pixels, sorted);
        const std::vector<double> found(values.begin(), values.end());
        const auto expected = on_host.apply(light);
        const double mean = sum(expected.values) / static_cast<double>(expected.values.size());
        for (std::size_t pixel = 0; pixel < found.size(); ++pixel) {
            ASSERT_NEAR(found[pixel], expected.values[pixel], 2e-6 * mean) << pixels.columns << ' ' << pixel;
        }
        EXPECT_NEAR(sum(found) / sum(expected.values), 1, 1e-6);
    }
}

// A device bounds the size of one allocation: the cells' images lie in several.
TEST(Waves, AreTheSameBitsOfLightInSeveralBuffers) {
    const auto instrument = test::microscope();
    const vulkan::Device device;
    constexpr ImageSize pixels{11, 6};
    const optics::PupilFilter filter(instrument, {.cells = 4, .parts = 3});
    const trace::WaveImage on_host(filter, pixels);
    const auto light = test::noisy_light(on_host.numbers(), 50);
    const std::size_t image = on_host.numbers_a_cell() * sizeof(std::uint64_t);
    std::vector<std::vector<float>> found;
    for (const auto& [most_bytes, buffers] : {std::pair<std::size_t, std::size_t>{0, 1}, {7 * image - 1, 3}, {1, 16}}) {
        trace::SortedLight sorted(device, 16, on_host.numbers_a_cell(), most_bytes);
        ASSERT_EQ(sorted.buffers().size(), buffers);
        sorted.write(light);
        found.push_back(made_by_device(device, filter, pixels, sorted));
        EXPECT_EQ(found.back(), found.front());
        const auto columns = static_cast<std::size_t>(on_host.columns());
        const auto of_cells = on_host.apply([&](int cell, int first_row, int rows) {
            std::vector<std::uint64_t> numbers(static_cast<std::size_t>(rows) * columns);
            sorted.read(static_cast<std::size_t>(cell), static_cast<std::size_t>(first_row) * columns, numbers);
            return numbers;
        });
        EXPECT_EQ(of_cells.values, on_host.apply(light).values);
        vulkan::Commands commands(device);
        sorted.clear(commands);
        commands.submit_and_wait();
        for (std::size_t cell = 0; cell < 16; ++cell) {
            std::vector<std::uint64_t> numbers(on_host.numbers_a_cell(), 1);
            sorted.read(cell, 0, numbers);
            EXPECT_EQ(numbers, std::vector<std::uint64_t>(numbers.size(), 0));
        }
    }
}

TEST(Waves, SortLightAlikeForwardAndBackwardOnDeviceAndHost) {
    const auto instrument = turned_microscope();
    const auto specimen = test::rough_specimen();
    constexpr double z = 0.004;
    std::vector<trace::Image> images;
    for (const auto estimator : {trace::Estimator::forward, trace::Estimator::backward}) {
        auto options = with_waves(estimator);
        // A thousandth of the paths round otherwise: a dozen of 400 000, which differ by 0.017 to 0.024 of the mean
        // from image to image.
        options.rays *= estimator == trace::Estimator::forward ? 2 : 1;
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

// While one exposure is asked for, the device has others.
TEST(Exposures, UnderWayAtATimeAreTheSameBits) {
    auto description = test::microscope_description();
    description.detector_pixels = ImageSize::square(32);
    description.detector_width /= 2;
    description.turned = true;
    const auto instrument = optics::assemble(description);
    const auto specimen = test::rough_specimen();
    for (const auto estimator : {trace::Estimator::forward, trace::Estimator::backward}) {
        for (const bool waves : {false, true}) {
            SCOPED_TRACE(waves);
            auto options = with_waves(estimator);
            options.rays /= 32;
            options.waves = waves ? options.waves : std::nullopt;
            const auto tracer = trace::make_device_tracer(instrument, specimen, options);
            std::vector<trace::Image> alone;
            for (std::uint32_t image = 0; image < 6; ++image) {
                alone.push_back(tracer->expose(0.001 * image, image));
            }
            std::deque<std::future<trace::Image>> under_way;
            double end = 0;
            for (std::uint32_t image = 0, begun = 0; image < alone.size(); ++image) {
                for (; begun < alone.size() && static_cast<int>(under_way.size()) < tracer->most_under_way(); ++begun) {
                    under_way.push_back(tracer->begin(0.001 * begun, begun));
                }
                const auto exposed = under_way.front().get();
                under_way.pop_front();
                EXPECT_EQ(exposed.flux.values, alone[image].flux.values);
                EXPECT_EQ(exposed.standard_error.values, alone[image].standard_error.values);
                EXPECT_EQ(exposed.detected, alone[image].detected);
                // The device works on one after the other.
                EXPECT_GE(exposed.device_begin, end);
                EXPECT_GE(exposed.device_end, exposed.device_begin);
                EXPECT_LE(exposed.device_seconds, exposed.device_end - exposed.device_begin + 1e-6);
                end = exposed.device_end;
            }
            EXPECT_NE(alone[0].flux.values, alone[1].flux.values);
            // An exposure whose result nobody asks for makes room again.
            for (int k = 0; k < 2 * tracer->most_under_way(); ++k) {
                tracer->begin(0, 0);
            }
            EXPECT_EQ(tracer->expose(0.001, 1).flux.values, alone[1].flux.values);
        }
    }
}

TEST(Waves, AreTheSameBitsForAnyBatch) {
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
