// The photon transfer measurement of a configured camera (camera/photon_transfer.hpp), as text, JSON and charts.
#pragma once

#include "camera/photon_transfer.hpp"
#include "core/messages/warning.hpp"

#include <nlohmann/json.hpp>

#include <string>

namespace vkfv::measurement {

struct CameraMeasurement {
    camera::Camera camera;
    camera::PhotonTransferOptions options;
    camera::PhotonTransferData data;
    camera::PhotonTransferFigures figures;
    camera::PhotonTransferFigures expected;
};

CameraMeasurement measure_camera(const camera::Camera& camera, const camera::PhotonTransferOptions& options,
                                 const camera::ImageTaker& take = {});

// A table with a column each for the camera's value, the measured value, its statistical error and its deviation.
std::string summary(const CameraMeasurement& measurement);
nlohmann::ordered_json camera_json(const CameraMeasurement& measurement);
// Warnings about values of the camera that falsify its figures.
std::vector<Warning> warnings_of(const camera::Camera& camera);
// Warnings about figures that the measurement could only bound.
std::vector<Warning> warnings_of(const CameraMeasurement& measurement);

// Charts as SVG: variance over mean; signal to noise ratio over photons, measured and by the model; grey value over
// photons, and its deviation from a line.
std::string transfer_chart(const CameraMeasurement& measurement);
std::string signal_to_noise_chart(const CameraMeasurement& measurement);
std::string linearity_chart(const CameraMeasurement& measurement);
// The points of the charts as CSV: series, photons, exposure_s, mean_dn, variance_dn2.
std::string transfer_table(const CameraMeasurement& measurement);

} // namespace vkfv::measurement
