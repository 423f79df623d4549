// The uncertainty of heights where brightness changes with focus.
//
// A focus measure is divided by the brightness of its window, so that an uneven light cancels. Let B(z) be this
// brightness, and let the texture alone make a curve exp(-(z - h)^2 / (2 s^2)). If the texture's strength follows B,
// the curve has its maximum at h. If it does not follow, the curve is exp(-(z - h)^2 / (2 s^2)) / B(z), with its
// maximum at
//
//   h - s^2 d ln B / dz.
//
// B changes with z where the directions of the light differ from place to place, as on curved surfaces that scatter
// narrowly: their light runs together or apart. Texture of glints then follows in part, since each direction has a
// pattern of its own, whose energies add; texture of reflectance follows. How far it does is not known from a stack, so
// s^2 d ln B / dz is a standard uncertainty, which all windows of one slope and curvature have in common: repeating and
// averaging do not reduce it.
//
// Brightness also changes with z as single grains leave a window. This differs from window to window and is seen in
// their disagreement (height_uncertainty.hpp). So products of s^2 d ln B / dz of neighbouring windows count, in which
// such changes average to zero.
#pragma once

#include "core/mathematics/grid.hpp"
#include "topography/focus_measure.hpp"

#include <cstddef>
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

    // height: the map, in steps of the scan from its first image, NaN where unknown. width: standard deviation of the
    // focus curves, in steps. step: of the scan, in the unit of the result. The slope of ln B over the images within
    // `width` of the mean height of a block is that of the least-squares line; brightness is relative to that of the
    // whole image, so that a lamp's flicker does not count. Blocks near an end of the scan, without heights or without
    // light have no slope. The square of the uncertainty is the mean product of the pairs of neighbours among a block
    // and those around it, or 0 if that is negative.
    BrightnessPull pull(const Grid<double>& height, double width, double step) const;

  private:
    double slope(std::size_t block, double height, double width) const;

    int columns_, rows_, side_;
    Grid<double> sums_;                      // of the image that is being added
    std::vector<std::vector<float>> images_; // mean brightness of the blocks, image by image
    std::vector<double> whole_;              // mean brightness of each image
};

} // namespace vkfv::topography
