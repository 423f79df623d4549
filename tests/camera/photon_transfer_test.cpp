// The measurement finds the figures that were put in; tests/acceptance/camera_ten_seeds does the same with larger
// images and ten seeds.
#include "camera/photon_transfer.hpp"
#include "camera/presets.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

namespace vkfv::camera {
namespace {

const PhotonTransferOptions small{.columns = 128, .rows = 96, .exposures = 50, .averaged = 24};

void expect_near(const MeasuredFigure& measured, double wanted, double tolerance, const char* what) {
    EXPECT_GT(measured.error, 0) << what;
    EXPECT_NEAR(measured.value, wanted, tolerance * wanted) << what;
}

TEST(PhotonTransfer, FindsWhatWasPutIn) {
    for (const auto preset : {Preset::imx250, Preset::imx900}) {
        CameraOptions options = preset_camera(preset).value();
        options.dark_current = 200;
        const Camera camera(options, optics::Spectrum::line(0.53));
        const auto found = photon_transfer_figures(measure_photon_transfer(camera, small));
        const auto wanted = expected_figures(camera);
        // The tolerances are some four standard errors of images that small.
        expect_near(found.gain, wanted.gain.value, 0.012, "K");
        expect_near(found.quantum_efficiency, wanted.quantum_efficiency.value, 0.012, "QE");
        expect_near(found.read_noise, wanted.read_noise.value, 0.035, "read noise");
        expect_near(found.capacity, wanted.capacity.value, 0.015, "capacity");
        expect_near(found.signal_to_noise_db, wanted.signal_to_noise_db.value, 0.003, "SNR");
        expect_near(found.dynamic_range_db, wanted.dynamic_range_db.value, 0.005, "dynamic range");
        expect_near(found.dark_signal, wanted.dark_signal.value, 0.04, "DSNU");
        expect_near(found.photo_response, wanted.photo_response.value, 0.04, "PRNU");
        expect_near(found.dark_current, wanted.dark_current.value, 0.02, "dark current");
        EXPECT_LT(found.linearity_error.value, 1e-3);
    }
}

// The twins are figures that are not expected of the camera: the tolerances above find them.
TEST(PhotonTransfer, FindsWhatIsOff) {
    CameraOptions options = preset_camera(Preset::imx900).value();
    const auto wanted = expected_figures(Camera(options, optics::Spectrum::line(0.53)));
    options.gain *= 1.03;
    options.full_well *= 0.95;
    options.photo_response *= 1.1;
    const auto found =
        photon_transfer_figures(measure_photon_transfer(Camera(options, optics::Spectrum::line(0.53)), small));
    EXPECT_GT(std::abs(found.gain.value / wanted.gain.value - 1), 0.012);
    EXPECT_GT(std::abs(found.capacity.value / wanted.capacity.value - 1), 0.015);
    EXPECT_GT(std::abs(found.photo_response.value / wanted.photo_response.value - 1), 0.04);
}

// Where quantisation dominates, the noise in the dark is bounded and not measured (EMVA 1288): the bound holds of what
// was put in, and where it is measured it is measured right, for gains on either side of the limit and ten cameras of
// each.
TEST(PhotonTransfer, DarkNoiseIsBoundedWhereQuantisationDominates) {
    const struct {
        double gain, read_noise; // DN/e-, e-
        bool bounded;
    } cases[] = {{0.05, 2.4, true}, {0.1, 2.4, true},  {0.5, 0.3, true}, {2, 0.15, true},
                 {0.05, 12, false}, {0.5, 1.2, false}, {1, 1.0, false},  {2, 2.4, false}};
    for (const auto& [gain, read_noise, bounded] : cases) {
        for (std::uint64_t seed = 1; seed <= 10; ++seed) {
            SCOPED_TRACE(fmt::format("K {} DN/e-, sigma_d {} e-, seed {}", gain, read_noise, seed));
            CameraOptions options = preset_camera(Preset::imx250).value();
            options.bit_depth = 16;
            options.gain = gain;
            options.read_noise = read_noise;
            options.dark_signal = 0.2;
            options.offset = 20;
            options.full_well = 4000;
            options.seed = seed;
            const Camera camera(options, optics::Spectrum::line(0.53));
            const auto found = photon_transfer_figures(
                measure_photon_transfer(camera, {.columns = 64, .rows = 48, .exposures = 50, .averaged = 16}));
            ASSERT_EQ(found.read_noise.bounded, bounded);
            if (bounded) {
                EXPECT_DOUBLE_EQ(found.read_noise.value, 0.40 / found.gain.value);
                EXPECT_LT(read_noise, found.read_noise.value);
                EXPECT_EQ(found.read_noise.error, 0);
                EXPECT_NEAR(found.threshold.value, (0.49 / found.gain.value + 0.5) / found.quantum_efficiency.value,
                            1e-12);
            } else {
                EXPECT_GT(found.read_noise.error, 0);
                // The read noise is off by no more than the share by which all gains are off, some 2 % for images of
                // this size: five of these.
                EXPECT_NEAR(found.read_noise.value, read_noise, 0.1 * read_noise);
            }
        }
    }
}

} // namespace
} // namespace vkfv::camera
