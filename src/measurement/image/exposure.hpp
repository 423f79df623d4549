// A single exposure with its image files, and the limits of its noise.
#pragma once

#include "configuration/configuration.hpp"
#include "core/mathematics/grid.hpp"
#include "core/mathematics/pixel_grid.hpp"
#include "measurement/scene/working_devices.hpp"
#include "optics/instrument/instrument.hpp"
#include "scan/store.hpp"
#include "specimen/specimen.hpp"
#include "trace/interface/tracer.hpp"
#include "trace/interface/tracer_identity.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vkfv::measurement {

// One exposure at a height of the focal plane (mm); if the configuration's scan has this height, the exposure is the
// stack's image there. checkpoint: the file that keeps a long exposure while it is half done; empty: none is kept.
struct Exposure {
    trace::Image image;
    PixelGrid grid; // of the pixels in the object plane
    trace::TracerIdentity tracer;
    std::optional<Grid<float>> diffracted; // light after diffraction; none with a camera or without [diffraction]
    std::optional<scan::Frame> taken;      // grey values of the camera, after diffraction; none without a camera
    scan::PixelType type = scan::PixelType::float32; // of the image files
    std::vector<Warning> warnings;                   // about the images of waves
};
Exposure expose(const Configuration& configuration, WorkingDevices& devices, const optics::Instrument& instrument,
                const specimen::Specimen& specimen, double focal_height, const std::filesystem::path& checkpoint = {});
// The pixels' mean over the root mean square of their standard errors.
double signal_to_noise(const trace::Image& image);

// The limits of the rays' noise beyond which vkfv warns, before a run and after it, and the noise that its remedies aim
// at.
namespace noise_limits {
inline constexpr double most_of_image = 0.5, good_of_image = 0.1;              // shares of an image's brightness
inline constexpr double most_of_curve_width = 0.1, good_of_curve_width = 0.05; // shares of the focus curves' deviation
} // namespace noise_limits

// A sentence with a remedy for noise that is this share of a pixel's mean light and should be `wanted`. The remedy
// depends on the configuration's source and estimator.
std::string remedy_of_noise(const Configuration& configuration, double share, double wanted);
// The value of trace.rays that lowers the noise from `share` to `wanted`.
std::string rays_for_noise(const Configuration& configuration, double share, double wanted);
// The files of an exposure with their names, in one folder: NAME, float32 W per pixel or a camera's grey values, and
// without a camera the diffracted image as NAME_diffracted.
std::vector<std::pair<std::filesystem::path, std::string>> image_files(const std::filesystem::path& name,
                                                                       const Exposure& exposure, double focal_height);

} // namespace vkfv::measurement
