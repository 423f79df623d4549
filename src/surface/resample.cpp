#include "surface/resample.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace vkfv::surface {
namespace {

// The weights of source points for a target point along one axis; none for a target beyond the source.
struct Taps {
    int first = 0;
    std::vector<double> weights;

    double total() const { return std::accumulate(weights.begin(), weights.end(), 0.0); }
};

struct Axis {
    bool averages = false;
    std::vector<Taps> taps; // one for each target point
};

// Keys' kernel with a = -1/2 for a place at the distance `u` after `point`, from the point before to the second after.
Taps cubic(int point, double u, int points) {
    const double u2 = u * u, u3 = u2 * u;
    std::vector<double> weights = {-0.5 * u + u2 - 0.5 * u3, 1 - 2.5 * u2 + 1.5 * u3, 0.5 * u + 2 * u2 - 1.5 * u3,
                                   -0.5 * u2 + 0.5 * u3};
    if (u == 0)
        return {point, {1}};
    // A missing point before the first continues the line through the first two: 2 z_0 - z_1; likewise at the end.
    int first = point - 1;
    if (first < 0) {
        weights[1] += 2 * weights[0];
        weights[2] -= weights[0];
        weights.erase(weights.begin());
        first = 0;
    }
    if (first + static_cast<int>(weights.size()) > points) {
        const double beyond = weights.back();
        weights.pop_back();
        weights[weights.size() - 1] += 2 * beyond;
        weights[weights.size() - 2] -= beyond;
    }
    return {first, weights};
}

// The weights of source cells by their share of the target's cell, of the width `width` in source pitches. If the
// target's ends cut source cells, the mean of their points lies off the target's middle; the slope of the linear
// interpolant between the ends corrects this.
Taps mean(double place, double width, int points) {
    constexpr double rounding = 1e-12; // in pitches: cells are cut equally at both ends or not at all
    const double low = place - width / 2, high = place + width / 2;
    const auto point_before = [points](double at) {
        return static_cast<int>(std::clamp(std::floor(at), 0.0, std::max(points - 2.0, 0.0)));
    };
    Taps taps{.first = point_before(low), .weights = {}};
    double moment = 0;
    for (int k = taps.first; k <= std::min(point_before(high) + 1, points - 1); ++k) {
        taps.weights.push_back(std::max(0.0, std::min(high, k + 0.5) - std::max(low, k - 0.5)) / width);
        moment += k * taps.weights.back();
    }
    const double off = place * taps.total() - moment;
    if (points > 1 && std::abs(off) > rounding * points)
        for (const auto& [end, factor] : {std::pair(high, off / width), std::pair(low, -off / width)}) {
            const int before = point_before(end);
            const auto tap = static_cast<std::size_t>(before - taps.first);
            taps.weights[tap] += factor * (before + 1 - end);
            taps.weights[tap + 1] += factor * (end - before);
        }
    return taps;
}

Axis axis(double first, double pitch, int points, double target_first, double target_pitch, int target_points) {
    constexpr double rounding = 1e-9; // tolerance of coordinates, per point
    Axis result{.averages = target_pitch > 1.01 * pitch, .taps = {}};
    for (int k = 0; k < target_points; ++k) {
        double place = (target_first + k * target_pitch - first) / pitch;
        if (std::abs(place - std::round(place)) < rounding * points)
            place = std::round(place);
        if (place < 0 || place > points - 1)
            result.taps.emplace_back();
        else if (result.averages)
            result.taps.push_back(mean(place, target_pitch / pitch, points));
        else
            result.taps.push_back(cubic(static_cast<int>(place), place - std::floor(place), points));
    }
    return result;
}

} // namespace

HeightMap resampled(const HeightMap& map, const HeightMap& onto) {
    const Axis x = axis(map.x0, map.pitch_x, map.columns(), onto.x0, onto.pitch_x, onto.columns());
    const Axis y = axis(map.y0, map.pitch_y, map.rows(), onto.y0, onto.pitch_y, onto.rows());

    // Sums of weighted heights, and of the magnitudes of weights at points that are not measured.
    Grid<double> heights(onto.columns(), map.rows()), gaps(onto.columns(), map.rows());
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < onto.columns(); ++column) {
            const Taps& taps = x.taps[static_cast<std::size_t>(column)];
            double height = 0, missing = 0;
            for (std::size_t k = 0; k < taps.weights.size(); ++k)
                if (const double z = map.height(taps.first + static_cast<int>(k), row); std::isfinite(z))
                    height += taps.weights[k] * z;
                else
                    missing += std::abs(taps.weights[k]);
            heights(column, row) = height;
            gaps(column, row) = missing;
        }

    HeightMap result = onto;
    for (int row = 0; row < onto.rows(); ++row) {
        const Taps& taps = y.taps[static_cast<std::size_t>(row)];
        for (int column = 0; column < onto.columns(); ++column) {
            double height = 0, missing = 0;
            for (std::size_t k = 0; k < taps.weights.size(); ++k) {
                const int source = taps.first + static_cast<int>(k);
                height += taps.weights[k] * heights(column, source);
                missing += std::abs(taps.weights[k]) * gaps(column, source);
            }
            const double present = x.taps[static_cast<std::size_t>(column)].total() * taps.total() - missing;
            const bool enough = present >= (x.averages && y.averages ? 0.9 : 0.99) - 1e-9; // 1e-9 allows for rounding
            result.height(column, row) = enough ? height / present : std::numeric_limits<double>::quiet_NaN();
        }
    }
    return result;
}

} // namespace vkfv::surface
