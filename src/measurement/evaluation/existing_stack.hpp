// Stacks whose images are there: of vkfv's own, evaluated anew, or of another instrument.
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

// Whether the images are taken in a random order, by this seed: a control, which must find no surface.
using Shuffle = std::optional<std::uint64_t>;

// A folder with its stack.toml; overrides of [topography], [diffraction] and [output] evaluate it otherwise.
struct OwnStack {
    std::filesystem::path folder;
    std::vector<TomlOverride> overrides;
    std::filesystem::path destination; // where the results go: the stack's own folder, or another
    Shuffle shuffle;
};

// InputError where an override changes what the images depend on, or an image is not whole.
EvaluatedStack evaluate_own_stack(const OwnStack& stack);

// Images alone: what an instrument's file does not say of them stands here. Lengths in mm.
struct ForeignStack {
    std::filesystem::path images;        // where they are, for the results
    std::vector<TomlOverride> overrides; // of [topography]
    double z_step = 0;                   // not 0; negative: the images descend
    double z_start = 0;                  // of the first image
    double pitch = 0;                    // of the pixels on the specimen
    Shuffle shuffle;
    CorrectionFiles corrections;
};

EvaluatedStack evaluate_images(const scan::ImageSeries& series, const ForeignStack& stack);

} // namespace vkfv::measurement
