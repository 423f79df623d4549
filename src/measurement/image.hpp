// A single image as the instrument takes it.
#pragma once

#include "measurement/exposure.hpp"

#include <filesystem>
#include <string>

namespace vkfv::measurement {

struct ImageResult {
    Exposure exposure;
    std::filesystem::path file;
    std::filesystem::path picture; // beside it, an SVG
};

// Takes the image at a height of the focal plane (mm) and writes it as `file`, a TIFF, with its picture; what is wrong
// with its light is told in the log. Throws InputError, DeviceError, RunError.
ImageResult measure_image(const Configuration& configuration, double focal_height, const std::filesystem::path& file);

// The ledger, counts, times and files as a text.
std::string summary(const ImageResult& image);

} // namespace vkfv::measurement
