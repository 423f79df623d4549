// The treatment and evaluation of a surface file.
#pragma once

#include "dimensions/find.hpp"
#include "measurement/surface/surface_report.hpp"
#include "surface_files/surface_file.hpp"

#include <filesystem>
#include <optional>

namespace vkfv::measurement {

struct SurfaceRequest {
    std::filesystem::path file;
    surface::ImageScale scale;                // for an image that states none itself
    bool accept_checksum = false;             // read a file whose checksums are stale
    surface::Band band;                       // treatment of the surface
    std::optional<surface::ProfileLine> line; // none: the middle row
    surface::ProfileSetting setting;          // the profile's own filters
    std::optional<dimensions::Sought> sought; // feature to find in the heights as they were read
    AskedRatios asked;
    std::optional<std::filesystem::path> out; // file for the treated surface; its name tells the format
};

// Treats and evaluates the surface. Throws InputError for a file that cannot be read, or for a treatment or line that
// the surface does not admit; RunError.
SurfaceFigures measure_surface(const SurfaceRequest& request);

} // namespace vkfv::measurement
