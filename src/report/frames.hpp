// The images of a stack for a page: few enough, small enough and in 8 bits, made as the images come.
#pragma once

#include "core/mathematics/grid.hpp"

#include <string>
#include <vector>

namespace vkfv::report {

// The mean of each block of `block` x `block` pixels of an image; blocks at the upper and right end may have fewer
// pixels. The mean is over the finite values; NaN where a block has none.
Grid<float> block_means(const Grid<float>& image, int block);
Grid<double> block_means(const Grid<double>& image, int block);

// The smallest block that leaves at most `most` pixels, and at most `most_a_side` along a side.
int block_for(int columns, int rows, double most, int most_a_side);

struct Frames {
    int block = 1;         // side in pixels of the image block that one pixel of a frame shows
    int every = 1;         // one frame for so many images
    int columns = 0;       // pixels of a frame
    int rows = 0;          // pixels of a frame
    float white = 0;       // value shown as white; 0 is black
    std::vector<double> z; // mm
    std::vector<std::string> pngs;
};

// Takes the images of a stack in order. It holds at most 24 MB, however long the stack, and the PNGs together little
// more than 6 MB.
class FrameTally {
  public:
    explicit FrameTally(int images) : images_(images) {}

    void add(const Grid<float>& image, double z);
    Frames finish();

  private:
    int images_;
    int taken_ = 0;
    Frames frames_;
    std::vector<Grid<float>> kept_;
};

} // namespace vkfv::report
