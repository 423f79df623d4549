#include "surface/minimum_zone.hpp"

#include "surface/filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace vkfv::surface {
namespace {

struct Point {
    double x, y, z; // mm
};

struct Tilt {
    double x = 0, y = 0; // slopes along x and y
};

double over(const Point& point, const Tilt& tilt) {
    return point.z - tilt.x * point.x - tilt.y * point.y;
}

double range_of(const std::vector<Point>& points, const Tilt& tilt) {
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    for (const Point& point : points) {
        const double z = over(point, tilt);
        lowest = std::min(lowest, z);
        highest = std::max(highest, z);
    }
    return highest - lowest;
}

// The place between -reach and reach of the minimum of a convex function, by golden-section search.
template <class Function>
double least_of(const Function& function, double reach) {
    constexpr double golden = 1 / std::numbers::phi;
    constexpr int rounds = 60; // reduce the interval to 3e-13
    double from = -reach, to = reach;
    double low = to - golden * (to - from), high = from + golden * (to - from);
    double at_low = function(low), at_high = function(high);
    for (int round = 0; round < rounds; ++round) {
        if (at_low < at_high) {
            to = high;
            high = low;
            at_high = at_low;
            low = to - golden * (to - from);
            at_low = function(low);
        } else {
            from = low;
            low = high;
            at_low = at_high;
            high = from + golden * (to - from);
            at_high = function(high);
        }
    }
    return 0.5 * (from + to);
}

Tilt least_tilt(const std::vector<Point>& points, const Tilt& reach) {
    const auto best_y = [&](double x) { return least_of([&](double y) { return range_of(points, {x, y}); }, reach.y); };
    const double x = least_of([&](double value) { return range_of(points, {value, best_y(value)}); }, reach.x);
    return {x, best_y(x)};
}

// The points of highest and lowest residual from a tilt.
std::array<Point, 2> extremes(const HeightMap& map, const Tilt& tilt) {
    std::array<Point, 2> found{};
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    for (int row = 0; row < map.rows(); ++row) {
        for (int column = 0; column < map.columns(); ++column) {
            const Point point{map.x(column) - map.x0, map.y(row) - map.y0, map.height(column, row)};
            const double z = over(point, tilt);
            if (z > highest) {
                highest = z;
                found[0] = point;
            }
            if (z < lowest) {
                lowest = z;
                found[1] = point;
            }
        }
    }
    return found;
}

} // namespace

double minimum_zone(const HeightMap& map) {
    constexpr double nearness = 1e-6;
    constexpr int most_rounds = 200;
    const Plane plane = least_squares_plane(map);
    if (!std::isfinite(plane.offset)) {
        return undefined;
    }
    const HeightMap level = remove_plane(map, plane);
    Tilt tilt;
    std::vector<Point> points;
    double zone = std::numeric_limits<double>::infinity();
    Tilt best;
    for (int round = 0; round < most_rounds; ++round) {
        const auto [highest, lowest] = extremes(level, tilt);
        const double range = over(highest, tilt) - over(lowest, tilt);
        if (range < zone) {
            zone = range;
            best = tilt;
        }
        points.push_back(highest);
        points.push_back(lowest);
        // Larger tilts need no search: over the map's length they alone would exceed the zone found so far.
        const double length_x = (map.columns() - 1) * map.pitch_x, length_y = (map.rows() - 1) * map.pitch_y;
        const Tilt reach{length_x > 0 ? 2 * zone / length_x : 0, length_y > 0 ? 2 * zone / length_y : 0};
        tilt = least_tilt(points, reach);
        if (range_of(points, tilt) >= (1 - nearness) * zone) {
            break;
        }
    }
    const double slope = std::hypot(plane.slope_x + best.x, plane.slope_y + best.y);
    return zone / std::hypot(1, slope);
}

} // namespace vkfv::surface
