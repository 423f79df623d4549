#include "camera/presets.hpp"

namespace vkfv::camera {

namespace {

// EMVA 1288 figures of a camera with Sony's IMX250 at 525 nm, given to the project as published (the reports cannot be
// named): quantum efficiency 63.40 %, temporal dark noise 2.44 e-, saturation capacity 10970 e-, largest signal to
// noise ratio 40.40 dB, dynamic range 71.45 dB. Derived: 10^(40.40 / 10) = 10965 e- agrees with the capacity. 10970 e-
// / 10^(71.45 / 20) less half an electron leaves 2.436 e- for all noise in the dark: quantisation does not contribute,
// so that grey values of 16 bits are meant, and the gain lets the charge clip at 0.97 of their range. Not published
// there, and assumed: DSNU, PRNU, offset; no dark current.
CameraOptions imx250() {
    CameraOptions camera;
    camera.quantum_efficiency.values = {0.6340};
    camera.read_noise = 2.44;
    camera.full_well = 10970;
    camera.gain = 5.5;
    camera.offset = 1000;
    camera.bit_depth = 16;
    camera.dark_signal = 1.0;
    camera.photo_response = 0.005;
    return camera;
}

// EMVA 1288 figures of a camera with Sony's IMX900 at 536 nm, given to the project as published (the reports cannot be
// named): quantum efficiency 91.25 %, temporal dark noise 5.560 e-, saturation capacity 9458 e-, gain 0.399 DN/e-,
// DSNU 3.7 e-, PRNU 0.7 %. Derived: largest signal to noise ratio sqrt(9458) = 39.76 dB, dynamic range 63.80 dB;
// 9458 e- are 3774 DN, so that grey values have 12 bits. Not published there, and assumed: offset; no dark current.
CameraOptions imx900() {
    CameraOptions camera;
    camera.quantum_efficiency.values = {0.9125};
    camera.read_noise = 5.560;
    camera.full_well = 9458;
    camera.gain = 0.399;
    camera.offset = 60;
    camera.bit_depth = 12;
    camera.dark_signal = 3.7;
    camera.photo_response = 0.007;
    return camera;
}

} // namespace

std::optional<CameraOptions> preset_camera(Preset preset) {
    switch (preset) {
    case Preset::imx250:
        return imx250();
    case Preset::imx900:
        return imx900();
    case Preset::none:
        break;
    }
    return std::nullopt;
}

} // namespace vkfv::camera
