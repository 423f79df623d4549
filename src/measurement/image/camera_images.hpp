// Images as the configured camera takes them: exposure time, grey values and noise.
#pragma once

#include "camera/camera.hpp"
#include "configuration/configuration.hpp"
#include "core/messages/warning.hpp"
#include "measurement/scene/working_devices.hpp"
#include "optics/instrument/instrument.hpp"
#include "optics/waves/diffraction.hpp"
#include "scan/store.hpp"
#include "specimen/specimen.hpp"
#include "trace/interface/tracer.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace vkfv::measurement {

// The way in which an image was taken. It is kept with the image, so that every run that has the image knows it.
struct CameraNote {
    double exposure_time = 0; // s
    camera::ImageLight light;

    nlohmann::ordered_json json() const;
    // The JSON in one line, whose numbers read back to the same bits.
    std::string text() const;
    // There is no note if no camera took the image.
    static std::optional<CameraNote> parse(const std::string& text);
};

// Converts the light of a configuration's exposures to images of its camera, blurred before that if [diffraction] asks
// for it. The configuration must outlive it.
class ImagingCamera {
  public:
    // exposure_time: s.
    ImagingCamera(const Configuration& configuration, const optics::Instrument& instrument, double exposure_time);

    // image: the image's place in the stack, which keys its random noise.
    scan::Frame develop(int image, const trace::Image& exposure) const;
    const camera::Camera& camera() const { return camera_; }

  private:
    const Configuration& configuration_;
    camera::Camera camera_;
    camera::FixedPattern pattern_;
    std::optional<optics::Diffraction> diffraction_;
    double exposure_time_;
};

// The exposure time (s) of all images of a stack: the one that the configuration gives, or one found by exposures with
// few rays at some of the heights. It depends on nothing but the configuration, the program and the device, so that any
// run or shard finds the same. focal_heights: mm, of the stack or of a single image. Throws DeviceError; RunError where
// no light arrives.
double exposure_time(const Configuration& configuration, const optics::Instrument& instrument,
                     const specimen::Specimen& specimen, std::span<const double> focal_heights,
                     const WorkingDevices& devices);
// The exposure time (s) of the images that the store holds already; if it holds none, the one found as above.
double exposure_time(const scan::ImageStore& store, const Configuration& configuration,
                     const optics::Instrument& instrument, const specimen::Specimen& specimen,
                     const WorkingDevices& devices);

// The flux (W) that a thousandth of the image exceeds. It is the flux of squares of pixels, as large as makes the
// light's noise small against the mean, since single pixels with few rays would have the brightest noise.
double brightest_flux(const Grid<double>& flux, const Grid<double>& standard_error);

// Figures over all images of a stack: means, and root mean squares of noise.
struct CameraFigures {
    double exposure_time = 0; // s
    camera::ImageLight light;
    double largest_saturated_share = 0; // the largest share of any image
    double ray_over_camera() const {    // 0 where all is saturated
        return light.camera_noise > 0 ? light.ray_noise / light.camera_noise : 0;
    }
};
CameraFigures camera_figures(std::span<const CameraNote> notes);
// The figures of a stack that is complete; there are none without a camera.
std::optional<CameraFigures> camera_figures(const scan::ImageStore& store);

// The members of results.json that describe the camera.
nlohmann::ordered_json camera_json(const camera::CameraOptions& options, const CameraFigures& figures);
// Warnings about noise of rays that the camera's does not hide, and about light that saturates.
std::vector<Warning> camera_warnings(const Configuration& configuration, const CameraFigures& figures);
// Warnings about the camera itself, and behind them camera_warnings().
std::vector<Warning> warnings_of_images(const Configuration& configuration, const CameraFigures& figures);

} // namespace vkfv::measurement
