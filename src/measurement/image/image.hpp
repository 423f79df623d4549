// A single image as the instrument takes it.
#pragma once

#include "measurement/image/exposure.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace vkfv::measurement {

struct ImageResult {
    Exposure exposure;
    double focal_height = 0; // mm
    std::filesystem::path file;
    std::filesystem::path picture; // SVG beside the image
    std::vector<Warning> warnings; // about the image's light and the instrument
};

// Takes the image at a height of the focal plane (mm) and writes it as the TIFF `file`, with its picture. The log gets
// the warnings too. Throws InputError, DeviceError, RunError.
ImageResult measure_image(const Configuration& configuration, double focal_height, const std::filesystem::path& file);

// The ledger, counts, times and files as a text.
std::string summary(const ImageResult& image);
nlohmann::ordered_json image_json(const ImageResult& image);

} // namespace vkfv::measurement
