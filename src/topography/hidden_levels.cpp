#include "topography/hidden_levels.hpp"

#include "core/threads/parallel_list.hpp"
#include "topography/focus_probes.hpp"
#include "topography/local_plane.hpp"
#include "topography/noise/image_halves.hpp"
#include "topography/noise/window_responses.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>

namespace vkfv::topography {
namespace {

constexpr std::size_t neighbours = 9;

// Levels 0.6 depths of focus apart have a share of 0.14 and more in the median, spherical aberration of 0.1 wave has
// 0.05.
constexpr double least_share = 0.08;

// The variance of height within a window of this radius by the map's slope, from the plane that fits the heights within
// twice the radius: the map shows it, so it is not hidden. Heights that jump between two levels have no slope.
double variance_by_slope(const Grid<double>& height, const LevelsAtPlace& place, int radius) {
    const int reach = 2 * radius;
    PlaneMoments around;
    double first = std::numeric_limits<double>::quiet_NaN(); // height from which the sums of squares count
    for (int row = std::max(0, place.row - reach); row <= std::min(height.rows - 1, place.row + reach); ++row) {
        for (int column = std::max(0, place.column - reach);
             column <= std::min(height.columns - 1, place.column + reach); ++column) {
            const double z = height(column, row), x = column - place.column, y = row - place.row;
            if (!std::isfinite(z)) {
                continue;
            }
            first = std::isnan(first) ? z : first;
            around.weight += 1;
            around.x += x;
            around.y += y;
            around.xx += x * x;
            around.xy += x * y;
            around.yy += y * y;
            around.z += z - first;
            around.xz += x * (z - first);
            around.yz += y * (z - first);
        }
    }
    if (around.weight < 3) {
        return 0;
    }
    const LocalPlane plane = plane_of(around);
    const double side = 2 * radius + 1;
    return (plane.rise_x * plane.rise_x + plane.rise_y * plane.rise_y) * (side * side - 1) / 12;
}

double squared_distance(const LevelsAtPlace& place, double column, double row) {
    return std::pow(place.column - column, 2) + std::pow(place.row - row, 2);
}

// The mean variance of levels over the places nearest to `middle`, in the unit of the heights squared; 0 unless they
// agree that there are several levels, since a single place is often wrong.
double variance_around(std::span<const LevelsAtPlace> places, const LevelsAtPlace& middle) {
    std::vector<LevelsAtPlace> near(places.begin(), places.end());
    const auto count = std::min(neighbours, near.size());
    std::ranges::nth_element(near, near.begin() + static_cast<std::ptrdiff_t>(count - 1), {},
                             [&](const auto& place) { return squared_distance(place, middle.column, middle.row); });
    near.resize(count);
    std::vector<double> shares;
    double sum = 0, squares = 0;
    for (const LevelsAtPlace& place : near) {
        shares.push_back(place.single > 0 ? place.variance / place.single : 0);
        sum += place.variance;
        squares += place.variance * place.variance;
    }
    const auto half = shares.begin() + static_cast<std::ptrdiff_t>(shares.size() / 2);
    std::ranges::nth_element(shares, half);
    const auto number = static_cast<double>(count);
    const double mean = sum / number;
    const double error = std::sqrt(std::max(0.0, squares / number - mean * mean) / std::max(1.0, number - 1));
    return *half > least_share && mean > 2 * error ? mean : 0;
}

} // namespace

HiddenLevels::HiddenLevels(std::vector<LevelsAtPlace> places, const Grid<double>& height, double step, int radius)
    : columns_(height.columns), rows_(height.rows) {
    if (places.empty()) {
        return;
    }
    for (LevelsAtPlace& place : places) {
        place.variance = step * step * place.variance - variance_by_slope(height, place, radius);
        place.single *= step * step;
        mean_ += place.variance / static_cast<double>(places.size());
    }
    std::vector<double> variances;
    for (const LevelsAtPlace& place : places) {
        variances.push_back(variance_around(places, place));
    }
    if (std::ranges::all_of(variances, [](double variance) { return variance == 0; })) {
        return;
    }
    tiles_ = Grid<double>(std::min(columns_, tiles_a_side), std::min(rows_, tiles_a_side));
    for (int row = 0; row < tiles_.rows; ++row) {
        for (int column = 0; column < tiles_.columns; ++column) {
            const double x = (column + 0.5) * columns_ / tiles_.columns, y = (row + 0.5) * rows_ / tiles_.rows;
            const auto nearest = std::ranges::min_element(
                places, {}, [&](const LevelsAtPlace& place) { return squared_distance(place, x, y); });
            tiles_(column, row) = variances[static_cast<std::size_t>(nearest - places.begin())];
        }
    }
}

double HiddenLevels::mean_deviation() const {
    return std::sqrt(std::max(0.0, mean_));
}

double HiddenLevels::variance(int column, int row) const {
    if (tiles_.values.empty()) {
        return 0;
    }
    const auto tile = [](int at, int tiles, int pixels) {
        return static_cast<int>(static_cast<std::int64_t>(at) * tiles / pixels);
    };
    return tiles_(tile(column, tiles_.columns, columns_), tile(row, tiles_.rows, rows_));
}

std::vector<LevelsAtPlace> FocusProbes::levels(const std::vector<double>& axial_weights) const {
    const WindowResponses responses(measure_, window_, channels_);
    const double width = curve_width();
    if (images_ < least_images_for_correlation || !(width > 0)) {
        return {};
    }
    const bool averaged = axial_weights.size() > 1;
    const Means means = means_of(
        averaged ? axial_weights : topography::axial_weights(topography::suitable_smoothing(width, images_)), images_);
    const std::vector<int> order = images_in_order(images_);
    const int apart = std::max(1, static_cast<int>(width / 3));
    const auto of_probes = parallel_list(static_cast<int>(probes_.size()), [&](int k) -> std::optional<LevelsAtPlace> {
        const Probe& probe = probes_[static_cast<std::size_t>(k)];
        if (probe.columns != responses.patch_side() || probe.rows != responses.patch_side()) {
            return std::nullopt;
        }
        const std::vector<double> smooth = averaged ? curve(probe, order, means) : averaged_singles(probe, means);
        const auto at = static_cast<int>(std::ranges::max_element(smooth) - smooth.begin());
        const auto top = static_cast<std::size_t>(at);
        if (at == 0 || at + 1 == images_) {
            return std::nullopt;
        }
        const auto responses_of = [&](const std::vector<Share>& shares) {
            return responses.of(mean_patch(probe, shares));
        };
        struct Pair {
            std::vector<double> one, other;
        };
        const auto pairs_at = [&](int image) {
            std::vector<Pair> pairs;
            for (const Halves& halves : halves_at(axial_weights, image, images_)) {
                if (!halves.one.empty() && !halves.other.empty()) {
                    pairs.push_back({responses_of(halves.one), responses_of(halves.other)});
                }
            }
            return pairs;
        };
        const auto energy = [&](const std::vector<Pair>& pairs) {
            double sum = 0;
            for (const Pair& pair : pairs) {
                sum += responses.product(pair.one, pair.other) / static_cast<double>(pairs.size());
            }
            return sum;
        };
        const auto product = [&](int below, int above, const std::vector<Pair>& low, const std::vector<Pair>& high) {
            return averaged ? 0.5 * (responses.product(low[0].one, high[0].other) +
                                     responses.product(low[0].other, high[0].one))
                            : responses.product(responses_of({{below, 1.0f}}), responses_of({{above, 1.0f}}));
        };
        const auto middle = pairs_at(at);
        double with_noise = 0;
        for (const Pair& pair : middle) {
            with_noise += (responses.product(pair.one, pair.one) + responses.product(pair.other, pair.other)) /
                          static_cast<double>(2 * middle.size());
        }
        // Where noise is stronger, the rest of the curve would be chosen by chance.
        constexpr double least_share_of_texture = 2.0 / 3;
        if (middle.empty() || !(energy(middle) > least_share_of_texture * with_noise)) {
            return std::nullopt;
        }
        // The sums over d, the first with half its weight, end where little of the curve is left.
        constexpr double least_energy = 0.2;
        const double whole = energy(middle);
        double weight = 0.5 * whole, squares = 0, single_weight = weight, single_squares = 0;
        for (int d = apart; at - d >= 0 && at + d < images_; d += apart) {
            const auto low = pairs_at(at - d), high = pairs_at(at + d);
            if (low.empty() || high.empty()) {
                break;
            }
            const double here = 0.5 * (energy(low) + energy(high));
            if (here < least_energy * whole) {
                break;
            }
            const double mirrored = product(at - d, at + d, low, high);
            weight += here;
            squares += here * d * d;
            single_weight += mirrored;
            single_squares += mirrored * d * d;
        }
        if (!(squares > 0) || !(single_weight > 0)) {
            return std::nullopt;
        }
        // The maximum lies between images: E is wider by the squared distance of the maximum from the image about which
        // E and P are taken.
        const double offset =
            (smooth[top + 1] - smooth[top - 1]) / (2 * (2 * smooth[top] - smooth[top - 1] - smooth[top + 1]));
        const double single = std::max(0.0, single_squares / single_weight);
        return LevelsAtPlace{.column = probe.column + probe.middle_column,
                             .row = probe.row + probe.middle_row,
                             .variance = squares / weight - single - std::min(0.25, offset * offset),
                             .single = single};
    });
    std::vector<LevelsAtPlace> found;
    for (const auto& place : of_probes) {
        if (place) {
            found.push_back(*place);
        }
    }
    return found.size() >= neighbours ? found : std::vector<LevelsAtPlace>();
}

} // namespace vkfv::topography
