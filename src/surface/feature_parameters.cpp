#include "surface/feature_parameters.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <future>
#include <numeric>
#include <vector>

namespace vkfv::surface {
namespace {

using Place = std::uint32_t;

struct Point {
    double height;
    Place place;
};

// The hills of points added in descending order of height. Hills grow and merge; each hill is a tree whose root is its
// peak.
class Hills {
  public:
    Hills(int columns, int rows)
        : columns_(columns), rows_(rows),
          parent_(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), none), order_(parent_.size()) {}

    // Adds the next lower point, the `number`-th; calls `ended` with each peak that ends there, at the saddle to a
    // higher one.
    template <class Ended>
    void add(Place place, std::uint32_t number, const Ended& ended) {
        const int column = static_cast<int>(place % static_cast<Place>(columns_)),
                  row = static_cast<int>(place / static_cast<Place>(columns_));
        std::array<Place, 8> roots{};
        std::size_t count = 0;
        for (int k = std::max(0, row - 1); k <= std::min(rows_ - 1, row + 1); ++k)
            for (int i = std::max(0, column - 1); i <= std::min(columns_ - 1, column + 1); ++i) {
                const Place near = static_cast<Place>(k) * static_cast<Place>(columns_) + static_cast<Place>(i);
                if (near != place && parent_[near] != none)
                    roots.at(count++) = root_of(near);
            }
        order_[place] = number;
        parent_[place] = place;
        if (count == 0)
            return;
        const auto highest = *std::min_element(roots.begin(), roots.begin() + static_cast<std::ptrdiff_t>(count),
                                               [&](Place a, Place b) { return order_[a] < order_[b]; });
        parent_[place] = highest;
        for (std::size_t k = 0; k < count; ++k)
            if (const Place root = roots.at(k); root != highest && parent_[root] == root) {
                ended(root);
                parent_[root] = highest;
            }
    }

    Place root_of(Place place) {
        while (parent_[place] != place)
            place = parent_[place] = parent_[parent_[place]];
        return place;
    }

  private:
    static constexpr Place none = 0xFFFFFFFF;
    int columns_, rows_;
    std::vector<Place> parent_;
    std::vector<std::uint32_t> order_;
};

// Reverses the order of points; clang 14 cannot compile std::ranges::subrange of these iterators.
struct Reversed {
    const std::vector<Point>& points;
    auto begin() const { return points.rbegin(); }
    auto end() const { return points.rend(); }
};

// The significant peaks of points in descending order; for points in ascending order the significant pits.
template <class Points>
std::vector<Place> significant_peaks(const HeightMap& map, const Points& descending, double least_rise) {
    const auto height = [&](Place place) { return map.height.values[place]; };
    Hills hills(map.columns(), map.rows());
    std::vector<Place> peaks;
    std::uint32_t number = 0;
    for (const Point& point : descending)
        hills.add(point.place, number++, [&](Place peak) {
            if (std::abs(height(peak) - point.height) >= least_rise)
                peaks.push_back(peak);
        });
    // Left are the highest peak and the hills that gaps isolate, which have met no higher one. Such a hill's rise
    // counts from its own lowest point, the last of its points in descending order.
    std::vector<Point> lowest;
    for (const Point& point : descending)
        if (const Place root = hills.root_of(point.place); root == point.place)
            lowest.push_back({point.height, root});
    if (lowest.size() > 1) {
        std::ranges::sort(lowest, {}, &Point::place);
        for (const Point& point : descending)
            std::ranges::lower_bound(lowest, hills.root_of(point.place), {}, &Point::place)->height = point.height;
    }
    for (const Point& one : lowest)
        if (one.place == descending.begin()->place || std::abs(height(one.place) - one.height) >= least_rise)
            peaks.push_back(one.place);
    return peaks;
}

double mean_of_extremes(const HeightMap& map, const std::vector<Place>& places, double mean, bool highest) {
    std::vector<double> heights;
    for (const Place place : places)
        heights.push_back(highest ? map.height.values[place] - mean : mean - map.height.values[place]);
    std::ranges::sort(heights, std::greater());
    heights.resize(std::min<std::size_t>(heights.size(), 5));
    return std::accumulate(heights.begin(), heights.end(), 0.0) / static_cast<double>(heights.size());
}

double mean_curvature(const HeightMap& map, const std::vector<Place>& peaks) {
    double sum = 0, count = 0;
    for (const Place place : peaks) {
        const int column = static_cast<int>(place) % map.columns(), row = static_cast<int>(place) / map.columns();
        if (column == 0 || row == 0 || column + 1 == map.columns() || row + 1 == map.rows())
            continue;
        const double twice = 2 * map.height(column, row);
        const double along_x =
            (map.height(column - 1, row) + map.height(column + 1, row) - twice) / (map.pitch_x * map.pitch_x);
        const double along_y =
            (map.height(column, row - 1) + map.height(column, row + 1) - twice) / (map.pitch_y * map.pitch_y);
        if (std::isfinite(along_x + along_y)) {
            sum -= 0.5 * (along_x + along_y);
            count += 1;
        }
    }
    return count > 0 ? sum / count : undefined;
}

} // namespace

FeatureParameters feature_parameters(const HeightMap& map, double pruning) {
    std::vector<Point> points;
    double sum = 0;
    for (std::size_t k = 0; k < map.height.values.size(); ++k)
        if (const double z = map.height.values[k]; std::isfinite(z)) {
            points.push_back({z, static_cast<Place>(k)});
            sum += z;
        }
    FeatureParameters result;
    if (points.empty())
        return result;
    std::ranges::sort(points, [](const Point& a, const Point& b) {
        return a.height > b.height || (a.height == b.height && a.place < b.place);
    });
    const auto count = static_cast<double>(points.size());
    const double mean = sum / count, least_rise = pruning * (points.front().height - points.back().height);
    auto pits_found =
        std::async(std::launch::async, [&] { return significant_peaks(map, Reversed{points}, least_rise); });
    const auto peaks = significant_peaks(map, points, least_rise);
    const auto pits = pits_found.get();
    result.s5p = mean_of_extremes(map, peaks, mean, true);
    result.s5v = mean_of_extremes(map, pits, mean, false);
    result.s10z = result.s5p + result.s5v;
    result.spd = static_cast<double>(peaks.size()) / (count * map.pitch_x * map.pitch_y);
    result.spc = mean_curvature(map, peaks);
    return result;
}

} // namespace vkfv::surface
