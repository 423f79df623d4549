// The Gaussian average along z of images that come one at a time.
#pragma once

#include "core/grid.hpp"

#include <deque>
#include <functional>
#include <vector>

namespace vkfv::topography {

// Image k becomes the mean of images k + d with weights exp(-d^2 / (2 s^2)), |d| <= 3 s (where the weight is
// 1 %), over the images there are: at the ends of the stack the weights present are normalised to one.
class AxialAverage {
  public:
    using Sink = std::function<void(const Grid<float>&)>;

    // s in images; 0 passes the images through unchanged.
    explicit AxialAverage(double standard_deviation);

    // Takes the next image and hands on the average that it completes, if any. All images have one size.
    void push(const Grid<float>& image, const Sink& sink);
    // Hands on the averages that still wait for images which do not come.
    void flush(const Sink& sink);

    // weights()[d] of an image d steps away, d = 0..radius; not normalised.
    const std::vector<double>& weights() const { return weights_; }

  private:
    void emit(const Sink& sink);

    std::vector<double> weights_;
    std::deque<Grid<float>> images_; // the last 2 radius + 1 at most
    int first_ = 0;                  // which image images_.front() is
    int next_ = 0;                   // the average to be handed on next
};

} // namespace vkfv::topography
