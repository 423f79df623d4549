#include "topography/slope_deviation.hpp"

#include "core/mathematics/units.hpp"

#include <cmath>
#include <stdexcept>

namespace vkfv::topography {

std::vector<SlopeBin> deviation_by_slope(const surface::HeightMap& deviation, const surface::HeightMap& truth,
                                         double width) {
    if (deviation.columns() != truth.columns() || deviation.rows() != truth.rows())
        throw std::invalid_argument("deviation_by_slope: both height maps must stand on the same grid");
    if (!(width > 0))
        throw std::invalid_argument("deviation_by_slope: the width must be positive");
    struct Sums {
        double points = 0, measured = 0, sum = 0, squares = 0;
    };
    std::vector<Sums> sums(static_cast<std::size_t>(pi / 2 / width) + 1);
    for (int row = 1; row + 1 < truth.rows(); ++row)
        for (int column = 1; column + 1 < truth.columns(); ++column) {
            const double slope_x =
                (truth.height(column + 1, row) - truth.height(column - 1, row)) / (2 * truth.pitch_x);
            const double slope_y =
                (truth.height(column, row + 1) - truth.height(column, row - 1)) / (2 * truth.pitch_y);
            const double angle = std::atan(std::hypot(slope_x, slope_y));
            if (!std::isfinite(angle) || !std::isfinite(truth.height(column, row)))
                continue;
            Sums& bin = sums[static_cast<std::size_t>(angle / width)];
            bin.points += 1;
            if (const double d = deviation.height(column, row); std::isfinite(d)) {
                bin.measured += 1;
                bin.sum += d;
                bin.squares += d * d;
            }
        }
    std::vector<SlopeBin> bins;
    for (std::size_t k = 0; k < sums.size(); ++k)
        if (const Sums& bin = sums[k]; bin.points > 0)
            bins.push_back({.from = static_cast<double>(k) * width,
                            .to = static_cast<double>(k + 1) * width,
                            .points = bin.points,
                            .measured_share = bin.measured / bin.points,
                            .bias = bin.sum / bin.measured,
                            .rms = std::sqrt(bin.squares / bin.measured)});
    return bins;
}

} // namespace vkfv::topography
