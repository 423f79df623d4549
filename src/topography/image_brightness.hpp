// The mean brightness of a stack's images, which their focus measures are divided by (shaders/focus/window.glsl).
#pragma once

#include "core/threads/parallel_rows.hpp"
#include "topography/axial_average.hpp"
#include "topography/focus_measure.hpp"

#include <numeric>
#include <span>
#include <vector>

namespace vkfv::topography {

class ImageBrightness {
  public:
    // The next image. Sums are those of rows, so that they do not depend on the number of threads.
    void add(const Channels& image) {
        std::vector<double> sums(static_cast<std::size_t>(image[0].rows));
        parallel_rows(image[0].columns, image[0].rows, [&](int first, int end) {
            for (int row = first; row < end; ++row) {
                for (const Grid<float>& channel : image) {
                    const float* values = channel.values.data() + channel.index(0, row);
                    sums[static_cast<std::size_t>(row)] =
                        std::accumulate(values, values + channel.columns, sums[static_cast<std::size_t>(row)]);
                }
            }
        });
        means_.push_back(std::accumulate(sums.begin(), sums.end(), 0.0) /
                         static_cast<double>(image.size() * image[0].values.size()));
    }

    // Of the image, in the unit of its values.
    double of(int image) const { return means_[static_cast<std::size_t>(image)]; }

    // Of the weighted mean of images.
    double of(std::span<const Share> shares) const {
        double sum = 0;
        for (const Share& share : shares) {
            sum += static_cast<double>(share.weight) * of(share.image);
        }
        return sum;
    }

  private:
    std::vector<double> means_;
};

} // namespace vkfv::topography
