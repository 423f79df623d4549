// The comparison of measured surfaces with a true one, each from its file.
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
    bool align = false;           // remove the lateral shift
    bool accept_checksum = false; // read files whose checksums are stale
    surface::Band band;
};

// The middle row of the first measurement and of the truth under it, both treated.
struct ComparedProfile {
    surface::ProfileLine line;
    surface::RoughnessProfile measured, truth;
};

struct ComparisonResult {
    topography::Comparison comparison;
    topography::LevelledPair pair; // the first measurement and the truth under it, treated
    ComparedProfile profile;
    std::vector<std::string> warnings; // about the files
};

// Compares the surfaces. Throws InputError for files that cannot be read, or surfaces that cannot be compared.
ComparisonResult compare_files(const ComparisonRequest& request);

} // namespace vkfv::measurement
