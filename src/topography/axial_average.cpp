#include "topography/axial_average.hpp"

#include "topography/parallel_rows.hpp"

#include <cmath>
#include <cstdlib>

namespace vkfv::topography {

AxialAverage::AxialAverage(double standard_deviation) {
    const int radius = static_cast<int>(std::ceil(3 * standard_deviation));
    weights_.push_back(1);
    for (int d = 1; d <= radius; ++d)
        weights_.push_back(std::exp(-0.5 * (d / standard_deviation) * (d / standard_deviation)));
}

void AxialAverage::push(const Grid<float>& image, const Sink& sink) {
    const int radius = static_cast<int>(weights_.size()) - 1;
    images_.push_back(image);
    if (first_ + static_cast<int>(images_.size()) - 1 == next_ + radius)
        emit(sink);
}

void AxialAverage::flush(const Sink& sink) {
    while (next_ < first_ + static_cast<int>(images_.size()))
        emit(sink);
}

void AxialAverage::emit(const Sink& sink) {
    const int radius = static_cast<int>(weights_.size()) - 1;
    const auto weight = [&](std::size_t k) {
        const auto distance = static_cast<std::size_t>(std::abs(first_ + static_cast<int>(k) - next_));
        return distance < weights_.size() ? weights_[distance] : 0.0;
    };
    double total = 0;
    for (std::size_t k = 0; k < images_.size(); ++k)
        total += weight(k);
    const Grid<float>& like = images_.front();
    Grid<float> average(like.columns, like.rows);
    parallel_rows(like.columns, like.rows, [&](int first_row, int end_row) {
        const std::size_t begin = like.index(0, first_row), end = like.index(0, end_row);
        for (std::size_t k = 0; k < images_.size(); ++k) {
            const auto share = static_cast<float>(weight(k) / total);
            for (std::size_t pixel = begin; pixel < end; ++pixel)
                average.values[pixel] += share * images_[k].values[pixel];
        }
    });
    ++next_;
    while (!images_.empty() && first_ < next_ - radius) {
        images_.pop_front();
        ++first_;
    }
    sink(average);
}

} // namespace vkfv::topography
