// Finds faults that many stacks of photographs have, from the images alone.
#pragma once

#include "topography/focus_measure.hpp"
#include "topography/registration.hpp"
#include "topography/saturation.hpp"

#include <future>
#include <vector>

namespace vkfv::topography {

struct StackFaults {
    double flicker = 0;       // standard deviation of the images' brightness from image to image, over its mean
    double exposure_step = 0; // largest lasting change of brightness between two images, over the mean; 0: none
    int step_image = 0;       // index in the stack of the first image after it
    double saturated_share = 0;
    // The largest displacement of the specimen's image from any image to a later one, in pixels, and the largest change
    // of its scale between two images; none unless it is several times its standard deviation.
    double wander = 0;
    double scale = 1;
    double corner_wander = 0; // displacement of the images' corners by the change of scale, in pixels
};

// Finds flicker and exposure steps. brightness: of each image, over the stack's mean.
void find_faults_of_light(const std::vector<double>& brightness, StackFaults& faults);

// Follows a stack's images as they come. Movement is found between some twenty of them, binned to at most 256 pixels a
// side, by other threads.
class StackFaultsFinder {
  public:
    explicit StackFaultsFinder(int images) : images_(images) {}

    // Takes the next image, as the camera gave it.
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
