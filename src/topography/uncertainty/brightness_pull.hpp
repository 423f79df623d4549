// The uncertainty of heights where brightness changes with focus.
//
// A focus measure is divided by the brightness of its window, so that an uneven light cancels. Let B(z) be this
// brightness, g = d ln B / dz, and let the texture alone make a curve exp(-(z - h)^2 / (2 s^2)). If the texture's
// strength follows B, the curve of single images has its maximum at h. If it does not follow, the curve is exp(-(z -
// h)^2 / (2 s^2)) / B(z), with its maximum at h - s^2 g.
//
// B changes with z where the directions of the light differ from place to place, as on curved surfaces that scatter
// narrowly: their light runs together or apart. Texture of glints then follows in part, since each direction has a
// pattern of its own, whose energies add; texture of reflectance follows. How far it does is not known from a stack.
//
// Images are averaged along z before the measure is divided. The average, a Gaussian of the standard deviation a,
// widens the curve to s^2 + a^2, while B keeps its slope: maxima move by -a^2 g if the texture follows, and by
// -(s^2 + a^2) g if it does not. So (s^2 + a^2) g is a standard uncertainty, which all windows of one slope and
// curvature have in common: repeating and averaging do not reduce it.
//
// Brightness also changes with z as single grains leave a window. This differs from window to window and is seen in
// their disagreement (height_uncertainty.hpp). So for the uncertainty products of this of neighbouring windows count,
// in which such changes average to zero.
#pragma once

#include "core/mathematics/grid.hpp"
#include "topography/focus_measure.hpp"

#include <optional>
#include <vector>

namespace vkfv::topography {

// A standard uncertainty by blocks of pixels. Empty: none is known.
struct BrightnessPull {
    int side = 1;        // pixels on the side of a block
    Grid<double> blocks; // in the unit of the heights

    // The uncertainty at a pixel; 0 where none is known.
    double at(int column, int row) const;
};

// The mean brightness of blocks of pixels in every image of a stack.
class BrightnessOfBlocks {
  public:
    // Blocks are as wide as the focus window, or wider, so that there are at most 128 on a side.
    BrightnessOfBlocks(int columns, int rows, int window_px);

    // Adds an image of that size.
    void add(const Channels& image);

    // The uncertainty of these heights, each block's by d ln B / dz at its mean height: the slope of the least-squares
    // line over the images within `width` steps; brightness is relative to that of the whole image, so that a lamp's
    // flicker does not count. It is 0 near the ends of the scan and where there is no light. height: the map, in steps
    // of the scan from its first image, NaN where it is unknown; width: standard deviation of the averaged focus
    // curves, in steps, 0 of curves without a form; step: of the scan, in the unit of the result. Its square is the
    // mean product of neighbours among seven blocks in a row or a column, whichever is larger, or 0 if both are
    // negative.
    BrightnessPull pull(const Grid<double>& height, double width, double step) const;

  private:
    // Images on either side for the line of a slope; empty where the curves have no form or the scan is too short.
    std::optional<int> reach_of(double width) const;
    // d ln B / dz a step: image by image, the slopes of all blocks; NaN where they are unknown.
    std::vector<std::vector<float>> slopes_of_blocks(int reach) const;
    // Linear between images; NaN off the scan.
    template <class AtImage>
    double between_images(double height, const AtImage& at_image) const;

    int columns_, rows_, side_;
    Grid<double> sums_;                      // of the image that is being added
    std::vector<std::vector<float>> images_; // mean brightness of the blocks, image by image
    std::vector<double> whole_;              // mean brightness of each image
};

} // namespace vkfv::topography
