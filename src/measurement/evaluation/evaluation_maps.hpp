// The map files of an evaluation.
#pragma once

#include "configuration/configuration.hpp"
#include "core/files/result_folder.hpp"
#include "measurement/evaluation/evaluation.hpp"
#include "measurement/evaluation/page_data.hpp"
#include "surface_files/provenance.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace vkfv::measurement {

// The files that heights are written to, and what these files say of the images. All of it is the same in every run, so
// that equal images give equal files.
struct TopographyFiles {
    std::string image_unit = "DN"; // of the images' values; other instruments write grey values
    std::vector<std::string> names = {"topography.tif", "topography.x3p"};
    surface::Provenance provenance = {.creator = "vkfv " VKFV_VERSION,
                                      .manufacturer = "vkfv",
                                      .model = "virtual focus-variation microscope",
                                      .version = VKFV_VERSION};
    // The date at which the images were taken, as they state it (xsd:dateTime), for formats that require a date; empty:
    // not known.
    std::string date_of_images{};
};

// The files that [output] surfaces names; their provenance has the configuration's digest.
TopographyFiles topography_files(const Configuration& configuration);

// Writes the maps into this folder within the results' folder, each file by a thread of its own. Returns the data of
// the report's page; `count` is the number of evaluations that share the page.
EvaluationData write_maps(ResultFolder& results, const std::filesystem::path& folder, const Evaluation& evaluation,
                          const TopographyFiles& files, int count);

// The last name of a folder's path, also for "out/" and ".".
std::string folder_name(const std::filesystem::path& folder);

} // namespace vkfv::measurement
