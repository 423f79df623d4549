// Evaluation of stacks whose images exist: stacks of vkfv anew, and images of other instruments.
#pragma once

#include "core/toml/toml_document.hpp"
#include "measurement/evaluation/evaluation_files.hpp"
#include "measurement/evaluation/frame_correction.hpp"
#include "scan/image_series.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace vkfv::measurement {

// The seed of the random order in which images are taken, if there is one: a control, which must find no surface.
using Shuffle = std::optional<std::uint64_t>;

// A folder with a stack.toml. Overrides of [topography], [diffraction] and [output] change its evaluation.
struct OwnStack {
    std::filesystem::path folder;
    std::vector<TomlOverride> overrides;
    std::filesystem::path destination; // folder of the results: the stack's own, or another
    Shuffle shuffle;
};

// Throws InputError where an override changes what the images depend on, or an image is not whole.
EvaluatedStack evaluate_own_stack(const OwnStack& stack);

// Images of another instrument, with the facts that its files may lack. Lengths in mm.
struct ForeignStack {
    std::filesystem::path images;        // file or folder, as results.json names it
    std::vector<TomlOverride> overrides; // of [topography]
    double z_step = 0;                   // not 0; negative: the images descend
    double z_start = 0;                  // height of the first image
    double pitch = 0;                    // of the pixels on the specimen
    Shuffle shuffle;
    CorrectionFiles corrections;
};

EvaluatedStack evaluate_images(const scan::ImageSeries& series, const ForeignStack& stack);

} // namespace vkfv::measurement
