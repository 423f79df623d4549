#include "camera/sensors.hpp"

#include <array>

namespace vkfv::camera {

namespace {

constexpr std::string_view adimec = "Adimec, differences between Pregius sensors";
constexpr std::string_view basler = "Basler, specifications of cameras with it";

constexpr std::array all_sensors = {
    Sensor{"CMV4000", 2040, 2046, 5.5, "1", basler},
    Sensor{"IMX226", 4024, 3036, 1.85, "1/1.7", basler},
    Sensor{"IMX250", 2448, 2048, 3.45, "2/3", adimec},
    Sensor{"IMX252", 2048, 1536, 3.45, "1/1.8", adimec},
    Sensor{"IMX253", 4096, 3000, 3.45, "1.1", adimec},
    Sensor{"IMX255", 4096, 2160, 3.45, "1", adimec},
    Sensor{"IMX265", 2048, 1536, 3.45, "1/1.8", basler},
    Sensor{"IMX540", 5320, 4600, 2.74, "1.2", "FLIR, specifications of the Blackfly S BFS-U3-244S8"},
    Sensor{"IMX548", 2448, 2048, 2.74, "1/1.8", basler},
    Sensor{"IMX900", 2064, 1552, 2.25, "1/3.1", "given to the project, not verified"},
    Sensor{"MT9P031", 2592, 1944, 2.2, "1/2.5", basler},
    Sensor{"PYTHON5000", 2592, 2048, 4.8, "1", basler},
};

constexpr std::array all_formats = {
    SensorFormat{"1/4", 3.6, 2.7}, SensorFormat{"1/3", 4.8, 3.6},     SensorFormat{"1/2.5", 5.76, 4.29},
    SensorFormat{"1/2", 6.4, 4.8}, SensorFormat{"1/1.8", 7.18, 5.32}, SensorFormat{"2/3", 8.8, 6.6},
    SensorFormat{"1", 12.8, 9.6},  SensorFormat{"1.1", 14.2, 10.4},   SensorFormat{"4/3", 17.3, 13.0},
};

} // namespace

std::span<const Sensor> sensors() {
    return all_sensors;
}

std::span<const SensorFormat> sensor_formats() {
    return all_formats;
}

} // namespace vkfv::camera
