#include "optics/waves/diffraction.hpp"

#include "core/mathematics/fourier.hpp"
#include "core/mathematics/units.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace vkfv::optics {
namespace {

using Complex = std::complex<double>;

} // namespace

Diffraction::Diffraction(const AiryPattern& pattern, int columns, int rows, double pitch)
    : columns_(columns), rows_(rows), symmetric_(columns, rows) {
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            symmetric_(column, row) = pattern.transfer(std::hypot(0.5 * column / columns, 0.5 * row / rows) / pitch);
}

Diffraction::Diffraction(const Grid<float>& point_spread, double point_spread_pitch, int columns, int rows,
                         double pitch)
    : columns_(columns), rows_(rows), any_(2 * columns, 2 * rows) {
    if (!(point_spread_pitch > 0 && point_spread_pitch <= pitch * (1 + 1e-9)))
        throw std::invalid_argument("diffraction: a point spread function of pixels no coarser than the image's");
    double sum = 0, x = 0, y = 0;
    for (int row = 0; row < point_spread.rows; ++row)
        for (int column = 0; column < point_spread.columns; ++column) {
            const auto value = static_cast<double>(point_spread(column, row));
            sum += value;
            x += value * column;
            y += value * row;
        }
    if (!(sum > 0) || !std::isfinite(sum))
        throw std::invalid_argument("diffraction: a point spread function with a positive sum");
    // The light of each value, spread over its square, is divided among the image's pixels that the square overlaps.
    const double ratio = point_spread_pitch / pitch;
    const auto wrapped = [](int k, int count) { return ((k % count) + count) % count; };
    for (int row = 0; row < point_spread.rows; ++row)
        for (int column = 0; column < point_spread.columns; ++column) {
            const double value = static_cast<double>(point_spread(column, row)) / sum;
            const double left = (column - 0.5 - x / sum) * ratio, low = (row - 0.5 - y / sum) * ratio;
            const auto covered = [ratio](int pixel, double begin) {
                return std::max(0.0, std::min(pixel + 0.5, begin + ratio) - std::max(pixel - 0.5, begin)) / ratio;
            };
            const int first_column = static_cast<int>(std::floor(left + 0.5));
            const int first_row = static_cast<int>(std::floor(low + 0.5));
            for (int j = first_row; j <= first_row + 1; ++j)
                for (int i = first_column; i <= first_column + 1; ++i)
                    any_(wrapped(i, any_.columns), wrapped(j, any_.rows)) += value * covered(i, left) * covered(j, low);
        }
    fourier_transform(any_);
}

Grid<float> Diffraction::apply(const Grid<float>& image) const {
    if (image.columns != columns_ || image.rows != rows_)
        throw std::invalid_argument("diffraction: an image of another size");
    return any_.values.empty() ? apply_symmetric(image) : apply_any(image);
}

Grid<float> Diffraction::apply_symmetric(const Grid<float>& image) const {
    Grid<double> grid(columns_, rows_);
    std::copy(image.values.begin(), image.values.end(), grid.values.begin());
    cosine_transform(grid);
    for (std::size_t k = 0; k < grid.values.size(); ++k)
        grid.values[k] *= symmetric_.values[k];
    inverse_cosine_transform(grid);
    Grid<float> result(columns_, rows_);
    std::transform(grid.values.begin(), grid.values.end(), result.values.begin(),
                   [](double value) { return static_cast<float>(value); });
    return result;
}

Grid<float> Diffraction::apply_any(const Grid<float>& image) const {
    Grid<Complex> grid(2 * columns_, 2 * rows_);
    const auto mirrored = [](int k, int count) { return k < count ? k : 2 * count - 1 - k; };
    for (int row = 0; row < grid.rows; ++row)
        for (int column = 0; column < grid.columns; ++column)
            grid(column, row) = static_cast<double>(image(mirrored(column, columns_), mirrored(row, rows_)));
    fourier_transform(grid);
    for (std::size_t k = 0; k < grid.values.size(); ++k)
        grid.values[k] *= any_.values[k];
    inverse_fourier_transform(grid);
    Grid<float> result(columns_, rows_);
    for (int row = 0; row < rows_; ++row)
        for (int column = 0; column < columns_; ++column)
            result(column, row) = static_cast<float>(grid(column, row).real());
    return result;
}

} // namespace vkfv::optics
