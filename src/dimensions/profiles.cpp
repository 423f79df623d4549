#include "dimensions/profiles.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace vkfv::dimensions {

using surface::HeightMap;

Profiles profiles_across(const HeightMap& map, const Frame& frame) {
    const double cosine = std::cos(frame.angle), sine = std::sin(frame.angle);
    const double width = std::hypot(map.pitch_y * cosine, map.pitch_x * sine);
    double first = std::numeric_limits<double>::infinity(), last = -first;
    for (const int column : {0, map.columns() - 1})
        for (const int row : {0, map.rows() - 1}) {
            const double v = frame.v(map.x(column), map.y(row));
            first = std::min(first, v);
            last = std::max(last, v);
        }
    Profiles profiles;
    profiles.spacing = map.pitch_x * map.pitch_y / width;
    profiles.lines.resize(static_cast<std::size_t>(std::lround((last - first) / width)) + 1);
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column)
            if (const double z = map.height(column, row); std::isfinite(z)) {
                const double dx = map.x(column) - frame.x, dy = map.y(row) - frame.y;
                const double v = dy * cosine - dx * sine;
                const auto line = static_cast<std::size_t>(std::max(0L, std::lround((v - first) / width)));
                profiles.lines[std::min(line, profiles.lines.size() - 1)].push_back(
                    {.u = dx * cosine + dy * sine, .v = v, .height = z});
            }
    for (auto& line : profiles.lines)
        std::ranges::sort(line, {}, &ProfilePoint::u);
    return profiles;
}

Reach reach_along(const HeightMap& map, const Frame& frame) {
    const double x_last = map.x(map.columns() - 1), y_last = map.y(map.rows() - 1);
    const auto way = [&](double sign) {
        const double cosine = sign * std::cos(frame.angle), sine = sign * std::sin(frame.angle);
        double shortest = std::numeric_limits<double>::infinity();
        for (const auto& [slope, place, low, high] :
             {std::array{cosine, frame.x, map.x0, x_last}, std::array{sine, frame.y, map.y0, y_last}})
            if (std::abs(slope) > 1e-12)
                shortest = std::min(shortest, ((slope > 0 ? high : low) - place) / slope);
        return std::max(0.0, shortest);
    };
    return {.before = way(-1), .behind = way(1)};
}

} // namespace vkfv::dimensions
