// Images as the configured camera takes them: exposure time, grey values, and what is known of their noise.
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

// How an image was taken, which is kept with it so that every run that has the image knows it.
struct CameraNote {
    double exposure_time = 0; // s
    camera::ImageLight light;

    nlohmann::ordered_json json() const;
    // The same in a line; its numbers read back to the same bits.
    std::string text() const;
    // None of an image that no camera took.
    static std::optional<CameraNote> parse(const std::string& text);
};

// Makes of the light of a configuration's exposures the images of its camera: blurred first, if [diffraction] says so.
// The configuration must outlive it.
class ImagingCamera {
  public:
    // exposure_time: s.
    ImagingCamera(const Configuration& configuration, const optics::Instrument& instrument, double exposure_time);

    // image: its place in the stack, by which noise is drawn.
    scan::Frame develop(int image, const trace::Image& exposure) const;
    const camera::Camera& camera() const { return camera_; }

  private:
    const Configuration& configuration_;
    camera::Camera camera_;
    camera::FixedPattern pattern_;
    std::optional<optics::Diffraction> diffraction_;
    double exposure_time_;
};

// s, the same for all images of a stack: as given, or by an exposure of few rays at some of its heights, which depends
// on nothing but the configuration, the program and the device, so that any run or shard finds the same. focal_heights:
// mm, of the stack, or of a single image. Throws DeviceError; RunError where no light arrives.
double exposure_time(const Configuration& configuration, const optics::Instrument& instrument,
                     const specimen::Specimen& specimen, std::span<const double> focal_heights,
                     const WorkingDevices& devices);
// That of images that a store holds already, else as above.
double exposure_time(const scan::ImageStore& store, const Configuration& configuration,
                     const optics::Instrument& instrument, const specimen::Specimen& specimen,
                     const WorkingDevices& devices);

// Flux (W) that a thousandth of the image exceeds. Pixels are put together in squares until the light's noise is small
// against their mean: few rays would find the brightest noise.
double brightest_flux(const Grid<double>& flux, const Grid<double>& standard_error);

// Of all images of a stack: their means, and of noise the root mean square.
struct CameraFigures {
    double exposure_time = 0; // s
    camera::ImageLight light;
    double largest_saturated_share = 0; // of the images'
    double ray_over_camera() const {    // 0 where all is saturated
        return light.camera_noise > 0 ? light.ray_noise / light.camera_noise : 0;
    }
};
CameraFigures camera_figures(std::span<const CameraNote> notes);
// Of the images of a stack that is complete; none without a camera.
std::optional<CameraFigures> camera_figures(const scan::ImageStore& store);

// For results.json.
nlohmann::ordered_json camera_json(const camera::CameraOptions& options, const CameraFigures& figures);
// Sentences on noise of rays that the camera's does not hide, and on light that saturates.
std::vector<Warning> camera_warnings(const Configuration& configuration, const CameraFigures& figures);
// The same after those on the camera itself.
std::vector<Warning> warnings_of_images(const Configuration& configuration, const CameraFigures& figures);

} // namespace vkfv::measurement
