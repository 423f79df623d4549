// Statistics of a focus stack that do not depend on which texture or roughness was drawn: brightness, contrast,
// sharpness at several scales and likeness of neighbours, image by image, and the distribution of focus curves.
#pragma once

#include "core/mathematics/grid.hpp"
#include "core/mathematics/pixel_grid.hpp"

#include <string>
#include <vector>

namespace vkfv::measurement {

// The properties of a stack and of its evaluation that decide which statistics there are.
struct StatisticsLayout {
    int images = 0;
    ImageSize pixels{};
    int window = 8; // pixels, side of the squares whose focus curves are taken
    // Whether the mean brightness of the whole stack counts. It does not where gain and exposure are not known.
    bool brightness = false;

    bool operator==(const StatisticsLayout&) const = default;
};

// Statistics of one kind: one for each image, or, for focus curves and brightness, single ones.
struct StatisticGroup {
    std::string name;  // a word
    std::string title; // with its unit, if it has one
    int count = 0;
    bool of_images = false; // one an image, in their order; false: numbers that `names` tell
    std::vector<std::string> names{};
};

// The groups in the order of the values.
std::vector<StatisticGroup> statistic_groups(const StatisticsLayout& layout);

// Statistics of a stack while its images come. Contrast and sharpness are relative to the brightness of their image,
// and logarithms, so that a change of the light's power changes only the brightness. Groups:
//   brightness   mean of an image over that of all images
//   contrast     ln of the pixels' standard deviation over the mean
//   sharpness_s  ln of a root mean square over the mean: the differences of neighbours of pixels binned s x s
//   likeness     Fisher's z of the correlation of an image with the next one
//   curves       place, width and height of the focus curves of squares of layout.window pixels, and their depth
//   power        ln of the mean of all images
// A focus curve is the sharpness over the images; the group has the mean and the scatter of each number, and of the
// depth, the lowest value over the highest, the mean.
class StackStatistics {
  public:
    explicit StackStatistics(const StatisticsLayout& layout);

    // Adds an image of layout.pixels; images come in their order. The first begins anew.
    void add(int image, const Grid<float>& values);
    // The statistics, after the last image. Throws RunError for a stack without light.
    std::vector<double> values() const;

  private:
    struct OfImage {
        double mean = 0, deviation = 0;
        std::vector<double> differences{}; // root mean square, by scale
    };

    StatisticsLayout layout_;
    std::vector<OfImage> images_;
    std::vector<double> likeness_;
    Grid<float> last_;
    int columns_ = 0, rows_ = 0;              // squares
    std::vector<std::vector<double>> curves_; // [square][image]
};

} // namespace vkfv::measurement
