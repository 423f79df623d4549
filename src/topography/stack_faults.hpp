// Faults that many stacks of photographs have are found from the images alone.
#pragma once

#include "topography/focus_measure.hpp"
#include "topography/registration.hpp"
#include "topography/saturation.hpp"

#include <future>
#include <vector>

namespace vkfv::topography {

struct StackFaults {
    double flicker = 0;       // standard deviation of the images' brightness from image to image, over its mean
    double exposure_step = 0; // the largest lasting change of brightness between two images, over the mean; 0: none
    int step_image = 0;       // the first image after it, by its place in the stack
    double saturated_share = 0;
    // The farthest that the specimen's image wanders from any image to a later one, in pixels, and the largest change
    // of its scale between two images; no movement unless it is several times its standard deviation.
    double wander = 0;
    double scale = 1;
    double corner_wander = 0; // of the images' corners by the change of scale, in pixels
};

// brightness: of each image, over the stack's mean.
void find_faults_of_light(const std::vector<double>& brightness, StackFaults& faults);

// Follows a stack's images as they come. Movement is found between some twenty of them, binned to 256 pixels a side at
// most, by other threads.
class StackFaultsFinder {
  public:
    explicit StackFaultsFinder(int images) : images_(images) {}

    // The next image, as the camera gave it.
    void add(const Channels& image);
    StackFaults finish();

  private:
    int images_;
    double pixels_a_bin_ = 1;
    int columns_ = 0;
    int rows_ = 0;
    std::vector<double> brightness_;
    SaturationCount saturation_;
    Grid<float> before_; // binned
    std::vector<std::future<MeasuredTransform>> movements_;
};

} // namespace vkfv::topography
