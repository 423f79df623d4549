#include "dimensions/correlated_errors.hpp"
#include "dimensions/least_squares.hpp"
#include "dimensions/levels.hpp"

#include <algorithm>
#include <limits>
#include <set>

namespace vkfv::dimensions {
namespace {

using surface::HeightMap;

// Extends squared distances along one line: each value becomes the minimum, over the line, of a value plus the squared
// distance to it, by the lower envelope of parabolas (P. Felzenszwalb, D. Huttenlocher, "Distance transforms of sampled
// functions", Theory of Computing 8 (2012)). pitch: mm.
void transform_line(std::vector<double>& values, double pitch) {
    const auto n = static_cast<int>(values.size());
    std::vector<int> parabola(values.size());
    std::vector<double> from(values.size() + 1);
    const std::vector<double> f = values;
    const auto at = [&](int q) { return f[static_cast<std::size_t>(q)]; };
    int last = -1;
    for (int q = 0; q < n; ++q) {
        if (!std::isfinite(at(q)))
            continue;
        double meeting = -std::numeric_limits<double>::infinity();
        while (last >= 0) {
            const int p = parabola[static_cast<std::size_t>(last)];
            const double square = pitch * pitch;
            meeting = ((at(q) + square * q * q) - (at(p) + square * p * p)) / (2 * square * (q - p));
            if (meeting > from[static_cast<std::size_t>(last)])
                break;
            --last;
            meeting = -std::numeric_limits<double>::infinity();
        }
        parabola[static_cast<std::size_t>(++last)] = q;
        from[static_cast<std::size_t>(last)] = meeting;
    }
    for (int q = 0, k = 0; q < n && last >= 0; ++q) {
        while (k < last && from[static_cast<std::size_t>(k) + 1] < q)
            ++k;
        const int p = parabola[static_cast<std::size_t>(k)];
        values[static_cast<std::size_t>(q)] = at(p) + std::pow(pitch * (q - p), 2);
    }
}

// The distance (mm, between points) of every point from the nearest one whose level is `to` or, if `other`, is not.
Grid<double> distances(const HeightMap& nominal, double to, bool other) {
    const Grid<double>& levels = nominal.height;
    Grid<double> result(levels.columns, levels.rows);
    for (std::size_t k = 0; k < levels.values.size(); ++k)
        result.values[k] = (levels.values[k] == to) != other ? 0 : std::numeric_limits<double>::infinity();
    std::vector<double> line;
    for (int row = 0; row < levels.rows; ++row) {
        line.assign(&result(0, row), &result(0, row) + levels.columns);
        transform_line(line, nominal.pitch_x);
        std::ranges::copy(line, &result(0, row));
    }
    for (int column = 0; column < levels.columns; ++column) {
        line.clear();
        for (int row = 0; row < levels.rows; ++row)
            line.push_back(result(column, row));
        transform_line(line, nominal.pitch_y);
        for (int row = 0; row < levels.rows; ++row)
            result(column, row) = std::sqrt(line[static_cast<std::size_t>(row)]);
    }
    return result;
}

// The index of the nominal point nearest to a place; none outside the map.
std::optional<std::size_t> nearest(const HeightMap& nominal, double x, double y) {
    const long column = std::lround((x - nominal.x0) / nominal.pitch_x),
               row = std::lround((y - nominal.y0) / nominal.pitch_y);
    if (column < 0 || row < 0 || column >= nominal.columns() || row >= nominal.rows())
        return std::nullopt;
    return nominal.height.index(static_cast<int>(column), static_cast<int>(row));
}

} // namespace

std::vector<PlateauHeight> plateau_heights(const HeightMap& map, const Plateaus& plateaus) {
    const HeightMap& nominal = plateaus.nominal;
    std::set<double> levels(nominal.height.values.begin(), nominal.height.values.end());
    levels.erase(0);
    std::vector<PlateauHeight> result;
    if (levels.empty())
        return result;
    // For each nominal point the level in which it is used: 0 the ground, k the k-th; -1 none.
    std::vector<int> belongs(nominal.height.values.size(), -1);
    std::vector<bool> near(belongs.size(), false), close(belongs.size(), false);
    int index = 0;
    for (const double level : levels) {
        ++index;
        result.push_back({.nominal = level});
        const auto inside = distances(nominal, level, true);
        const auto outside = distances(nominal, level, false);
        const double width = 2 * *std::ranges::max_element(inside.values);
        for (std::size_t k = 0; k < belongs.size(); ++k) {
            if (nominal.height.values[k] == level && inside.values[k] >= width / 3)
                belongs[k] = index;
            near[k] = near[k] || outside.values[k] <= width;
            close[k] = close[k] || outside.values[k] < width / 3;
        }
    }
    for (std::size_t k = 0; k < belongs.size(); ++k)
        if (nominal.height.values[k] == 0 && near[k] && !close[k])
            belongs[k] = 0;

    const auto for_points = [&](const auto& visit) {
        for (int row = 0; row < map.rows(); ++row)
            for (int column = 0; column < map.columns(); ++column)
                if (const double z = map.height(column, row); std::isfinite(z))
                    if (const auto place = nearest(nominal, map.x(column), map.y(row)); place && belongs[*place] >= 0)
                        visit(column, row, belongs[*place], z);
    };
    std::vector<double> counts(result.size() + 1);
    for_points([&](int, int, int level, double) { counts[static_cast<std::size_t>(level)] += 1; });
    // The unknowns are the plane, and the heights of the plateaus that were measured.
    constexpr double least_points = 10;
    std::vector<std::size_t> unknown(result.size());
    std::size_t unknowns = 3;
    for (std::size_t k = 0; k < result.size(); ++k)
        unknown[k] = counts[k + 1] >= least_points ? unknowns++ : 0;
    if (counts[0] < least_points || unknowns == 3)
        return result;
    const auto functions_into = [&](int column, int row, int level, std::span<double> values) {
        std::ranges::fill(values, 0);
        values[0] = 1;
        values[1] = map.x(column) - map.x0;
        values[2] = map.y(row) - map.y0;
        if (level > 0 && unknown[static_cast<std::size_t>(level) - 1] > 0)
            values[unknown[static_cast<std::size_t>(level) - 1]] = 1;
    };
    const auto functions = [&](int column, int row, int level) {
        std::vector<double> values(unknowns);
        functions_into(column, row, level, values);
        return values;
    };
    const auto counts_for = [&](int level) { return level == 0 || unknown[static_cast<std::size_t>(level) - 1] > 0; };
    LeastSquares squares(unknowns);
    for_points([&](int column, int row, int level, double z) {
        if (counts_for(level))
            squares.add(functions(column, row, level), z);
    });
    const auto solution = squares.solve();
    if (!solution)
        return result;
    Grid<double> residues(map.columns(), map.rows(), surface::undefined);
    Grid<int> level_of(map.columns(), map.rows());
    for_points([&](int column, int row, int level, double z) {
        if (!counts_for(level))
            return;
        const auto values = functions(column, row, level);
        for (std::size_t k = 0; k < unknowns; ++k)
            z -= values[k] * solution->unknowns[k];
        residues(column, row) = z;
        level_of(column, row) = level;
    });
    const auto covariance = fit_covariance(residues, *solution, [&](std::size_t place, std::span<double> values) {
        const auto columns = static_cast<std::size_t>(map.columns());
        functions_into(static_cast<int>(place % columns), static_cast<int>(place / columns), level_of.values[place],
                       values);
    });
    for (std::size_t k = 0; k < result.size(); ++k)
        if (unknown[k] > 0) {
            result[k].height = solution->unknowns[unknown[k]];
            result[k].standard_error = covariance.standard_error(unknown[k]);
        }
    return result;
}

} // namespace vkfv::dimensions
