#include "dimensions/sphere_form.hpp"

#include "core/mathematics/units.hpp"
#include "dimensions/correlated_errors.hpp"
#include "dimensions/least_squares.hpp"
#include "dimensions/profiles.hpp"

#include <algorithm>
#include <array>

namespace vkfv::dimensions {

using surface::HeightMap;

std::optional<SphereForm> sphere_form(const HeightMap& map) {
    SphereForm form{.sphere = surface::least_squares_sphere(map)};
    const auto& sphere = form.sphere;
    if (!std::isfinite(sphere.radius))
        return std::nullopt;
    const double side = sphere.convex ? 1 : -1;
    LeastSquares squares(4);
    std::array<double, 4> functions{}; // derivatives by the unknowns of least_squares_sphere()
    const auto functions_at = [&](std::size_t place, std::span<double> values) {
        const auto column = static_cast<int>(place % static_cast<std::size_t>(map.columns()));
        const auto row = static_cast<int>(place / static_cast<std::size_t>(map.columns()));
        const double x = map.x(column) - sphere.x_centre, y = map.y(row) - sphere.y_centre;
        const double height = map.height(column, row) - sphere.apex + side * sphere.radius;
        const double r = std::hypot(x, y, height);
        std::ranges::copy(std::array{-x / r, -y / r, -height / r, side * height / r - 1}, values.begin());
        return r - sphere.radius;
    };
    Grid<double> distances(map.columns(), map.rows(), surface::undefined);
    double sum = 0, count = 0, lowest = 0, highest = 0;
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column)
            if (std::isfinite(map.height(column, row))) {
                const double distance = functions_at(map.height.index(column, row), functions);
                squares.add(functions, distance);
                distances(column, row) = distance;
                sum += distance * distance;
                lowest = count > 0 ? std::min(lowest, distance) : distance;
                highest = count > 0 ? std::max(highest, distance) : distance;
                count += 1;
            }
    form.peak_to_valley = highest - lowest;
    form.rms = std::sqrt(sum / count);
    const auto solution = squares.solve();
    form.radius_error = solution && count > 4 ? fit_covariance(distances, *solution, functions_at).standard_error(3)
                                              : surface::undefined;
    return form;
}

std::optional<SphereForm> sphere_form(const HeightMap& map, const SphereCap& cap) {
    constexpr double least_share = 0.25, inner_share = 0.9;
    const double depth = std::abs(cap.height);
    const double reach = inner_share * std::sqrt(depth * (2 * cap.radius - depth));
    HeightMap region = map;
    double count = 0;
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column) {
            double& z = region.height(column, row);
            if (!(std::hypot(map.x(column) - cap.frame.x, map.y(row) - cap.frame.y) < reach))
                z = surface::undefined;
            count += std::isfinite(z) ? 1 : 0;
        }
    if (count < least_share * pi * reach * reach / (map.pitch_x * map.pitch_y))
        return std::nullopt;
    return sphere_form(region);
}

std::optional<FlankAngles> flank_angles(const HeightMap& map, const Prism& prism) {
    constexpr double least_share = 0.5, least_profiles = 0.2;
    const double length = std::abs(prism.height) / std::tan(prism.flank_angle);
    const double from = 0.5 * prism.top_width + length / 6, to = 0.5 * prism.top_width + length * 5 / 6;
    const Profiles profiles = profiles_across(map, prism.frame);
    std::vector<double> before, behind;
    for (const auto& line : profiles.lines)
        for (auto* angles : {&before, &behind}) {
            LeastSquares flank(2);
            double points = 0;
            for (const auto& point : line)
                if (const double u = angles == &before ? -point.u : point.u; u >= from && u <= to) {
                    flank.add(std::array{1.0, point.u}, point.height);
                    points += 1;
                }
            const auto solution = points >= least_share * (to - from) / profiles.spacing ? flank.solve() : std::nullopt;
            angles->push_back(solution ? std::atan(std::abs(solution->unknowns[1])) : surface::undefined);
        }
    const FlankAngles result{.before = mean_of(before), .behind = mean_of(behind)};
    const int fewest = std::min(result.before.count, result.behind.count);
    if (fewest < least_profiles * static_cast<double>(profiles.lines.size()))
        return std::nullopt;
    return result;
}

} // namespace vkfv::dimensions
