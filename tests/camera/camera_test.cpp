// The camera's model agrees with closed forms.
#include "camera/camera.hpp"

#include "camera/presets.hpp"
#include "camera/saturation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace vkfv::camera {
namespace {

CameraOptions plain() {
    CameraOptions options;
    options.quantum_efficiency.values = {0.5};
    options.full_well = 10000;
    options.gain = 4;
    options.offset = 200;
    options.bit_depth = 16;
    return options;
}

const optics::Spectrum green = optics::Spectrum::line(0.5);

struct Moments {
    double mean = 0, variance = 0;
};
Moments moments_of(const Grid<float>& image) {
    const auto count = static_cast<double>(image.values.size());
    const double mean = std::accumulate(image.values.begin(), image.values.end(), 0.0) / count;
    double square = 0;
    for (const double value : image.values) {
        square += (value - mean) * (value - mean);
    }
    return {mean, square / (count - 1)};
}

Moments image_of(const CameraOptions& options, double electrons, double seconds = 1e-3) {
    const Camera camera(options, green);
    const Grid<double> flux(200, 150, electrons / camera.electrons_per_joule() / seconds);
    return moments_of(camera.image(flux, seconds, 0, camera.fixed_pattern(200, 150)));
}

// A flux of 1 W at 0.5 um is lambda / (h c) photons a second; the numeral is not made of the program's constants.
TEST(Camera, WattsBecomePhotonsByWavelength) {
    const Camera camera(plain(), green);
    EXPECT_NEAR(camera.photons_per_joule(), 2.5170582e18, 1e12);
    EXPECT_DOUBLE_EQ(camera.quantum_efficiency(), 0.5);
}

TEST(Camera, QuantumEfficiencyIsThePhotonsMeanOverTheSpectrum) {
    CameraOptions options = plain();
    options.quantum_efficiency = {.wavelengths_um = {0.4, 0.6}, .values = {0.2, 0.8}};
    const Camera camera(options, optics::Spectrum::lines({0.45, 0.55}, {1, 1}));
    // The sensor has 0.35 and 0.65 electrons a photon, and a line has photons in proportion to its wavelength.
    EXPECT_NEAR(camera.quantum_efficiency(), (0.45 * 0.35 + 0.55 * 0.65) / (0.45 + 0.55), 1e-12);
}

// All noise together has the mean K (electrons + dark) + offset and the variance K^2 (electrons + dark current + read^2
// + dsnu^2 + (prnu electrons)^2) + 1/12, within four standard errors.
TEST(Camera, MeanAndVarianceAreTheModels) {
    CameraOptions options = plain();
    options.read_noise = 8;
    options.dark_signal = 15;
    options.photo_response = 0.01;
    options.dark_current = 5e4;
    const auto [mean, variance] = image_of(options, 3000);
    const double electron_variance = 3000 + 50 + 64 + 225 + 900;
    const double wanted = 16 * electron_variance + 1.0 / 12;
    EXPECT_NEAR(mean, 4 * 3050 + 200, 4 * std::sqrt(wanted / 30000));
    EXPECT_NEAR(variance, wanted, 4 * wanted * std::sqrt(2.0 / 30000));
}

TEST(Camera, FramesAreAveraged) {
    CameraOptions options = plain();
    options.frames = 16;
    const double wanted = 16 * 2000.0 / 16;
    EXPECT_NEAR(image_of(options, 2000).variance, wanted, 4 * wanted * std::sqrt(2.0 / 30000));
}

TEST(Camera, ChargeAndGreyValuesEnd) {
    CameraOptions options = plain();
    const auto full = image_of(options, 1e6);
    EXPECT_NEAR(full.mean, 4 * Camera(options, green).clip() + 200, 1e-3);
    EXPECT_EQ(full.variance, 0);
    options.bit_depth = 12;
    EXPECT_EQ(image_of(options, 1e6).mean, 4095);
    options.offset = 0;
    options.read_noise = 100;
    const auto dark = image_of(options, 0);
    EXPECT_GT(dark.mean, 0); // values below 0 are clipped to 0
}

// A filter of waves leaves some pixels below zero. A camera counts no electrons there, and its dark charge as anywhere.
TEST(Camera, LightBelowZeroIsNone) {
    CameraOptions options = plain();
    const auto dark = image_of(options, -20);
    EXPECT_EQ(dark.mean, 200); // the offset
    EXPECT_EQ(dark.variance, 0);
    options.dark_current = 5e4; // 50 electrons in 1 ms: mean and variance of their number, within four standard errors
    const auto charged = image_of(options, -20);
    EXPECT_NEAR(charged.mean, 4 * 50 + 200, 4 * std::sqrt(16 * 50.0 / 30000));
    EXPECT_NEAR(charged.variance, 16 * 50, 4 * 16 * 50 * std::sqrt(2.0 / 30000));
    // The light that is told is the light that is counted: of 300 electrons and of -100, 150 in the mean.
    const Camera camera(options, green);
    Grid<double> flux(20, 10, 300 / camera.electrons_per_joule());
    for (int column = 0; column < 20; column += 2) {
        for (int row = 0; row < 10; ++row) {
            flux(column, row) *= -1.0 / 3;
        }
    }
    EXPECT_NEAR(camera.light_of(flux, Grid<double>(20, 10), 1).mean, 150, 1e-9);
}

TEST(Camera, APixelDependsOnItsPlaceImageAndSeedAlone) {
    CameraOptions options = plain();
    options.photo_response = 0.01;
    const Camera camera(options, green);
    const auto pattern = camera.fixed_pattern(300, 200); // on several threads
    Grid<double> flux(300, 200, 1e-12);
    const auto image = camera.image(flux, 1e-3, 7, pattern);
    EXPECT_EQ(camera.image(flux, 1e-3, 7, pattern).values, image.values);
    EXPECT_NE(camera.image(flux, 1e-3, 8, pattern).values, image.values);
    flux.values[0] = 0;
    auto other = camera.image(flux, 1e-3, 7, pattern);
    EXPECT_NE(other.values[0], image.values[0]);
    other.values[0] = image.values[0];
    EXPECT_EQ(other.values, image.values);
    options.noise_seed = 5;
    const Camera noisier(options, green);
    EXPECT_EQ(noisier.fixed_pattern(300, 200).response.values, pattern.response.values);
    EXPECT_NE(noisier.image(flux, 1e-3, 7, pattern).values, other.values);
}

TEST(Camera, NoiseOfRaysAndOfTheCameraAreToldApart) {
    CameraOptions options = plain();
    options.read_noise = 3;
    options.frames = 4;
    const Camera camera(options, green);
    const double electron = 1 / camera.electrons_per_joule(); // J
    const auto light = camera.light_of(Grid<double>(2, 2, 400 * electron), Grid<double>(2, 2, 5 * electron), 1);
    EXPECT_NEAR(light.mean, 400, 1e-9);
    EXPECT_NEAR(light.ray_noise, 5, 1e-9);
    EXPECT_NEAR(light.camera_noise, std::sqrt((400 + 9 + 1.0 / 12 / 16) / 4), 1e-9);
}

// With fewer bits grey values end before the charge does: there the image saturates, and by that an exposure is set.
TEST(Camera, SaturatesWhereGreyValuesEnd) {
    CameraOptions options = plain();
    options.bit_depth = 14; // (16383 - 200) / 4 electrons
    const Camera camera(options, green), of_more_bits(plain(), green);
    EXPECT_DOUBLE_EQ(camera.saturation_charge(), 4045.75);
    EXPECT_DOUBLE_EQ(of_more_bits.saturation_charge(), 10000);
    const double flux = 1e-12;
    EXPECT_NEAR(flux * camera.time_to(0.8, flux) * camera.electrons_per_joule(), 0.8 * 4045.75, 1e-6);
    const Grid<double> bright(10, 10, 5000 / camera.electrons_per_joule() / 1e-3);
    EXPECT_NEAR(camera.light_of(bright, {}, 1e-3).saturated_share, 1, 1e-12);
    EXPECT_EQ(camera.light_of(bright, {}, 1e-3).camera_noise, 0);
    EXPECT_EQ(of_more_bits.light_of(bright, {}, 1e-3).saturated_share, 0);
    EXPECT_NEAR(of_more_bits.light_of(bright, {}, 1e-3).camera_noise, std::sqrt(5000 + 1.0 / 12 / 16), 1e-9);
}

// A script of scipy found the clips: Poisson probabilities summed up, averaged over normal responses, and the peak of
// the variance on a grid of means. With equal responses the peak lies 2.8 to 3 % below the clip, as cameras have it.
TEST(Saturation, TheVarianceIsLargestAtTheFullWell) {
    EXPECT_NEAR(clip_of_capacity(10970, 0), 11281, 1);
    EXPECT_NEAR(clip_of_capacity(9458, 0), 9744, 1);
    EXPECT_NEAR(clip_of_capacity(10970, 0.005), 11316, 2);
    EXPECT_NEAR(clip_of_capacity(9458, 0.007), 9796, 2);
    EXPECT_NEAR(clip_of_capacity(1000, 0), 1081, 1);
    EXPECT_NEAR(clip_of_capacity(100, 0), 121, 1);
}

TEST(Presets, HaveWhatIsPublished) {
    const Camera imx250(preset_camera(Preset::imx250).value(), optics::Spectrum::line(0.525));
    EXPECT_NEAR(20 * std::log10(imx250.largest_signal_to_noise()), 40.40, 0.005);
    EXPECT_NEAR(20 * std::log10(imx250.dynamic_range()), 71.45, 0.02);
    EXPECT_NEAR(imx250.quantum_efficiency(), 0.6340, 1e-9);
    for (const auto preset : {Preset::imx250, Preset::imx900}) {
        const Camera camera(preset_camera(preset).value(), green);
        EXPECT_GT(camera.converter_end(), camera.clip());
    }
    EXPECT_FALSE(preset_camera(Preset::none));
}

} // namespace
} // namespace vkfv::camera
