// The correction of a stack's images by two further images of the same camera: one without light, and one of even
// light.
#pragma once

#include "core/mathematics/grid.hpp"

#include <filesystem>
#include <optional>
#include <vector>

namespace vkfv::measurement {

// Files of one image or of several pages, whose mean is taken, or folders of such files. Either may be missing.
struct CorrectionFiles {
    std::optional<std::filesystem::path> dark{};       // light off, at the stack's exposure time
    std::optional<std::filesystem::path> flat_field{}; // an even surface out of focus
};

// A corrected image is (image - dark) / (flat field - dark) times the mean of (flat field - dark), channel by channel:
// the inverse of a camera whose pixels have an offset and a gain each. The factor keeps the size of the numbers. Pixels
// that are lit in the dark image, or dark in the flat field, are dead: they become means of their neighbours that are
// not.
class FrameCorrection {
  public:
    FrameCorrection() = default; // leaves images as they are
    // Throws InputError where an image cannot be read, or the two differ in size or channels.
    explicit FrameCorrection(const CorrectionFiles& files);

    // Throws InputError where the image has another size or other channels. `name` names the image in the error.
    std::vector<Grid<float>> corrected(std::vector<Grid<float>> image, const std::filesystem::path& name) const;
    int dead_pixels() const { return static_cast<int>(dead_.size()); }

  private:
    std::filesystem::path file_;           // one of the two images, for messages
    std::vector<Grid<float>> dark_, gain_; // empty: not corrected
    std::vector<std::size_t> dead_;        // indices into a grid
    std::vector<bool> is_dead_;
};

} // namespace vkfv::measurement
