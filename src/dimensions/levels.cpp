#include "dimensions/levels.hpp"

#include "dimensions/least_squares.hpp"
#include "dimensions/profiles.hpp"

#include <algorithm>
#include <array>

namespace vkfv::dimensions {
namespace {

using surface::HeightMap;

constexpr double least_share = 0.5; // share of a region's points

// A range of u on the upper (+1) or the lower level (-1).
struct Region {
    double from, to;
    double side;
};

bool has(const Region& region, const ProfilePoint& point) {
    return point.u >= region.from && point.u <= region.to;
}

// The regions in which a profile has enough points.
std::vector<Region> covered(const std::vector<Region>& regions, const std::vector<ProfilePoint>& line, double spacing) {
    std::vector<Region> result;
    std::ranges::copy_if(regions, std::back_inserter(result), [&](const Region& region) {
        const auto points = std::ranges::count_if(line, [&](const auto& point) { return has(region, point); });
        return points >= 2 && static_cast<double>(points) >= least_share * (region.to - region.from) / spacing;
    });
    return result;
}

// True if a profile has all regions or, with `any`, at least three, which determine its slope, with both levels among
// them.
bool enough(const std::vector<Region>& found, std::size_t asked, bool any) {
    const auto upper = std::ranges::count_if(found, [](const Region& region) { return region.side > 0; });
    return any ? found.size() >= 3 && upper > 0 && upper < std::ssize(found) : found.size() == asked;
}

std::optional<LevelDifference> fitted_levels(const HeightMap& map, const Frame& frame,
                                             const std::vector<Region>& regions, bool any = false) {
    const Profiles profiles = profiles_across(map, frame);
    std::vector<double> differences, middles;
    LeastSquares areal(4), along(3);
    for (const auto& line : profiles.lines) {
        const auto found = covered(regions, line, profiles.spacing);
        differences.push_back(surface::undefined);
        middles.push_back(surface::undefined);
        if (!enough(found, regions.size(), any))
            continue;
        LeastSquares one(3);
        for (const auto& region : found)
            for (const auto& point : line)
                if (has(region, point)) {
                    one.add(std::array{1.0, point.u, region.side}, point.height);
                    along.add(std::array{1.0, point.u, region.side}, point.height);
                    areal.add(std::array{1.0, point.u, region.side, point.v}, point.height);
                }
        if (const auto solution = one.solve()) {
            differences.back() = 2 * solution->unknowns[2];
            middles.back() = solution->unknowns[0];
        }
    }
    LevelDifference result{.profiles = mean_of(differences)};
    // At least a fifth of the profiles must count, so that no corner represents the field; across a field's diagonal a
    // third are long.
    if (5 * result.profiles.count < std::ssize(profiles.lines))
        return std::nullopt;
    const auto whole = areal.solve();
    const auto solution = whole ? whole : along.solve(); // a single profile determines no slope along v
    if (!solution)
        return std::nullopt;
    result.middle = solution->unknowns[0];
    result.slope_u = solution->unknowns[1];
    result.areal = 2 * solution->unknowns[2];
    result.slope_v = whole ? solution->unknowns[3] : 0;
    result.middles = std::move(middles);
    return result;
}

// True if the map covers at least half of the outer regions.
bool reaches(const HeightMap& map, const Frame& frame, double from, double to) {
    const Reach reach = reach_along(map, frame);
    return std::min(reach.before, reach.behind) >= from + least_share * (to - from);
}

double middle_of(const std::vector<double>& crossings) {
    double sum = 0;
    for (const double u : crossings)
        sum += u;
    return crossings.empty() ? surface::undefined : sum / static_cast<double>(crossings.size());
}

// The width of each profile at the level halfway: at the common one or, if `own`, at the profile's. NaN if the profile
// does not cross it near both edges.
std::vector<double> widths_at(const Profiles& profiles, const Groove& groove, const LevelDifference& depth, bool own) {
    std::vector<double> widths;
    for (std::size_t line = 0; line < profiles.lines.size(); ++line) {
        const auto& points = profiles.lines[line];
        const auto over = [&](const ProfilePoint& point) {
            return point.height -
                   (own ? depth.middles[line] + depth.slope_u * point.u : depth.halfway(point.u, point.v));
        };
        std::vector<double> before, behind;
        for (std::size_t k = 1; k < points.size(); ++k) {
            const double a = over(points[k - 1]), b = over(points[k]);
            if (!std::isfinite(a) || (a < 0) == (b < 0))
                continue;
            const double u = points[k - 1].u + (points[k].u - points[k - 1].u) * a / (a - b);
            if (std::abs(std::abs(u) - groove.width / 2) <= groove.width / 3)
                (u < 0 ? before : behind).push_back(u);
        }
        widths.push_back(middle_of(behind) - middle_of(before));
    }
    return widths;
}

} // namespace

std::optional<LevelDifference> groove_depth(const HeightMap& map, const Groove& groove) {
    const double width = groove.width, side = groove.depth < 0 ? -1 : 1;
    if (!reaches(map, groove.frame, width / 2 + width / 3, width / 2 + width))
        return std::nullopt;
    // The outer regions are cut at the map's border.
    const Reach reach = reach_along(map, groove.frame);
    const double inner = width / 2 + width / 3, outer = width / 2 + width;
    return fitted_levels(map, groove.frame,
                         {{-std::min(outer, reach.before), -inner, side},
                          {-width / 6, width / 6, -side},
                          {inner, std::min(outer, reach.behind), side}});
}

std::optional<LevelDifference> step_height(const HeightMap& map, const Step& step) {
    const Reach reach = reach_along(map, step.frame);
    const double length = std::min(reach.before, reach.behind);
    if (!(length > 0))
        return std::nullopt;
    return fitted_levels(map, step.frame, {{-length, -length / 3, -1}, {length / 3, length, 1}});
}

std::optional<Mean> groove_width(const HeightMap& map, const Groove& groove, const LevelDifference& depth) {
    const Profiles profiles = profiles_across(map, groove.frame);
    Mean mean = mean_of(widths_at(profiles, groove, depth, false));
    if (!(mean.count > 0))
        return std::nullopt;
    if (const double error = mean_of(widths_at(profiles, groove, depth, true)).standard_error; std::isfinite(error))
        mean.standard_error = error;
    return mean;
}

std::optional<LevelDifference> line_depth(const HeightMap& map, const Grating& grating) {
    const Reach reach = reach_along(map, grating.frame);
    const double ground = grating.period - grating.line_width;
    std::vector<Region> regions;
    const auto add = [&](double middle, double width, double side) {
        if (middle - width / 6 >= -reach.before && middle + width / 6 <= reach.behind)
            regions.push_back({middle - width / 6, middle + width / 6, side});
    };
    const auto first = static_cast<int>(std::floor(-reach.before / grating.period));
    const auto last = static_cast<int>(std::ceil(reach.behind / grating.period));
    for (int line = first; line <= last; ++line) {
        add(line * grating.period, grating.line_width, 1);
        add((line + 0.5) * grating.period, ground, -1);
    }
    return fitted_levels(map, grating.frame, regions, true);
}

} // namespace vkfv::dimensions
