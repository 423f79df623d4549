// A surface file, treated and evaluated.
#pragma once

#include "dimensions/find.hpp"
#include "measurement/surface/surface_report.hpp"
#include "surface_files/surface_file.hpp"

#include <filesystem>
#include <optional>

namespace vkfv::measurement {

struct SurfaceRequest {
    std::filesystem::path file;
    surface::ImageScale scale;                // of an image that states none itself
    bool accept_checksum = false;             // of a file whose checksums are stale
    surface::Band band;                       // what is done to the surface
    std::optional<surface::ProfileLine> line; // none: the middle row
    surface::ProfileSetting setting;          // the profile's own filters
    std::optional<dimensions::Sought> sought; // whose dimensions are found in the heights as they were read
    AskedRatios asked;
    std::optional<std::filesystem::path> out; // where the treated surface is written; its name tells the format
};

// Throws InputError for a file that cannot be read, or a treatment or line that the surface does not admit; RunError.
SurfaceFigures measure_surface(const SurfaceRequest& request);

} // namespace vkfv::measurement
