// Measured against true surfaces, each from its file.
#pragma once

#include "surface/band.hpp"
#include "surface/roughness_profile.hpp"
#include "topography/comparison.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace vkfv::measurement {

struct ComparisonRequest {
    std::vector<std::filesystem::path> measurements; // at least one; repeated ones stand on one grid
    std::filesystem::path truth;
    bool align = false;           // the lateral shift is removed
    bool accept_checksum = false; // of files whose checksums are stale
    surface::Band band;
};

// Along the middle row, of the first measurement and of the truth under it, treated.
struct ComparedProfile {
    surface::ProfileLine line;
    surface::RoughnessProfile measured, truth;
};

struct ComparisonResult {
    topography::Comparison comparison;
    topography::LevelledPair pair; // the first measurement and the truth under it, treated
    ComparedProfile profile;
    std::vector<std::string> warnings; // of the files
};

// Throws InputError for files that cannot be read, or of surfaces that cannot be compared.
ComparisonResult compare_files(const ComparisonRequest& request);

} // namespace vkfv::measurement
