// The maps of an evaluation as files.
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

// The files that heights are written to, and what these files say of the images. Nothing in here differs from run to
// run, so that equal images give equal files.
struct TopographyFiles {
    std::string image_unit = "DN"; // of the images' values: what other instruments write are grey values
    std::vector<std::string> names = {"topography.tif", "topography.x3p"};
    surface::Provenance provenance = {.creator = "vkfv " VKFV_VERSION,
                                      .manufacturer = "vkfv",
                                      .model = "virtual focus-variation microscope",
                                      .version = VKFV_VERSION};
    // When the images were taken, as they state it (xsd:dateTime), for the formats that cannot do without a date;
    // empty: it is not known.
    std::string date_of_images{};
};

// The files that [output] surfaces names; they also hold the configuration's digest.
TopographyFiles topography_files(const Configuration& configuration);

// Into this folder in the results' own, each file by a thread of its own. Returns what the page shows of them; `count`
// evaluations share it.
EvaluationData write_maps(ResultFolder& results, const std::filesystem::path& folder, const Evaluation& evaluation,
                          const TopographyFiles& files, int count);

// A folder's own name, also of "out/" and ".".
std::string folder_name(const std::filesystem::path& folder);

} // namespace vkfv::measurement
