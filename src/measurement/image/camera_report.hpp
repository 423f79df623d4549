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

// A table: put in, measured, statistical error, deviation.
std::string summary(const CameraMeasurement& measurement);
nlohmann::ordered_json camera_json(const CameraMeasurement& measurement);
// Sentences on what the camera's values do to its figures.
std::vector<Warning> warnings_of(const camera::Camera& camera);
// Sentences on figures that the measurement could only bound.
std::vector<Warning> warnings_of(const CameraMeasurement& measurement);

// SVG: variance over mean; signal to noise ratio over photons, with the model's; grey value over photons, and its
// deviation from a line.
std::string transfer_chart(const CameraMeasurement& measurement);
std::string signal_to_noise_chart(const CameraMeasurement& measurement);
std::string linearity_chart(const CameraMeasurement& measurement);
// The points of these charts: series, photons, exposure_s, mean_dn, variance_dn2.
std::string transfer_table(const CameraMeasurement& measurement);

} // namespace vkfv::measurement
