// From the images of a stack to topography, deviation from truth and the files that hold them.
#pragma once

#include "app/configuration.hpp"
#include "topography/compare.hpp"
#include "topography/topography.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <functional>
#include <optional>

namespace vkfv::app {

struct Evaluation {
    topography::TopographyOptions options; // that the heights were found by
    topography::Topography topography;
    surface::HeightMap truth;
    topography::Deviation deviation;                         // levelled
    std::optional<topography::Deviation> filtered_deviation; // and L-filtered; none without a nesting index
    double l_filter = 0;                                     // nesting index, mm
    double seconds = 0;                                      // wall clock
};

// `image(k)` is the image at the k-th position of the configuration's scan, in W.
Evaluation evaluate(const Configuration& configuration, const optics::Instrument& instrument,
                    const specimen::Specimen& specimen, const std::function<Grid<float>(int)>& image);

// Writes topography.tif, truth.tif, deviation.tif (float32 um, the first row has the highest y) and
// results.json into the folder; `more` joins the figures in results.json, whose other entries of an earlier
// run stay.
void write_evaluation(const std::filesystem::path& folder, const Evaluation& evaluation,
                      const nlohmann::ordered_json& more);

// The figures as a text of a few lines.
std::string summary(const Evaluation& evaluation);

} // namespace vkfv::app
