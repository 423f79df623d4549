// Image sensors by name and by optical format: how many pixels of which size.
#pragma once

#include <span>
#include <string_view>

namespace vkfv::camera {

// An image sensor with the columns, rows and square pixels that makers of cameras read out.
struct Sensor {
    std::string_view name;
    int columns = 0;
    int rows = 0;
    double pixel_um = 0;     // side of a pixel
    std::string_view format; // optical format in inches: "2/3"
    std::string_view source; // who states the figures
};
std::span<const Sensor> sensors();

// The picture that an optical format names, mm. The names are those of camera tubes and no lengths: a chip of 2/3 inch
// is 8.8 mm wide.
struct SensorFormat {
    std::string_view name; // "2/3", in inches
    double width = 0;
    double height = 0;
};
std::span<const SensorFormat> sensor_formats();

} // namespace vkfv::camera
