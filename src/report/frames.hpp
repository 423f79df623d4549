// A stack's images for a page: few enough, small enough and in 8 bits, made while the images pass.
#pragma once

#include "core/mathematics/grid.hpp"

#include <string>
#include <vector>

namespace vkfv::report {

// Of an image of `columns` x `rows` pixels each block of `block` x `block` becomes its mean; those at the upper and
// right end may have fewer pixels. Where nothing in a block is finite the mean is NaN, else that of what is.
Grid<float> block_means(const Grid<float>& image, int block);
Grid<double> block_means(const Grid<double>& image, int block);

// The smallest block by which no more than `most` pixels are left, none more than `most_a_side` along a side.
int block_for(int columns, int rows, double most, int most_a_side);

struct Frames {
    int block = 1;         // pixels of an image along the sides of one of a frame
    int every = 1;         // images
    int columns = 0;       // of a frame
    int rows = 0;          //
    float white = 0;       // the value that is shown white; 0 is black
    std::vector<double> z; // mm
    std::vector<std::string> pngs;
};

// Takes the images of a stack in their order. It holds 24 MB at most, however long the stack, and the PNGs together
// have little more than 6 MB.
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
