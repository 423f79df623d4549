#include "dimensions/transfer.hpp"

#include "core/mathematics/units.hpp"
#include "dimensions/correlated_errors.hpp"
#include "dimensions/least_squares.hpp"
#include "dimensions/profiles.hpp"
#include "dimensions/statistics.hpp"

#include <algorithm>
#include <array>

namespace vkfv::dimensions {
namespace {

using surface::HeightMap;

// The phase of a chirp in turns since its start, as in shaders/physics/surface_function.glsl.
struct ChirpPhase {
    double start, stop, sweep; // cycles per mm; sweep: cycles per mm^2

    explicit ChirpPhase(const Chirp& chirp)
        : start(1 / chirp.period_start), stop(1 / chirp.period_stop), sweep((stop - start) / chirp.length) {}
    double turns(double s) const { return (start + 0.5 * sweep * s) * s; }
    // The place of this number of turns: the root of the quadratic in a form without cancellation.
    double place(double turns) const {
        return 2 * turns / (start + std::sqrt(std::max(0.0, start * start + 2 * sweep * turns)));
    }
};

struct Slopes {
    double u = 0, v = 0;
};

Slopes tilt_beside(const Profiles& profiles, const ChirpPhase& phase, double start) {
    LeastSquares whole(5);
    for (const auto& line : profiles.lines)
        for (const auto& point : line) {
            const double angle = 2 * pi * phase.turns(point.u - start);
            whole.add(std::array{1.0, point.u, point.v, std::cos(angle), std::sin(angle)}, point.height);
        }
    const auto solution = whole.solve();
    return solution ? Slopes{solution->unknowns[1], solution->unknowns[2]} : Slopes{};
}

} // namespace

std::vector<Transfer> chirp_transfer(const HeightMap& map, const Chirp& chirp) {
    constexpr double least_share = 0.75; // share of a wave's points that a profile needs
    const Profiles profiles = profiles_across(map, chirp.frame);
    const ChirpPhase phase(chirp);
    const Slopes tilt = tilt_beside(profiles, phase, chirp.start);
    const Reach reach = reach_along(map, chirp.frame);
    const auto waves = static_cast<int>(phase.turns(chirp.length) + 1e-9);
    std::vector<Transfer> transfers;
    for (int wave = 0; wave < waves; ++wave) {
        const double from = phase.place(wave), to = phase.place(wave + 1);
        if (chirp.start + from < -reach.before || chirp.start + to > reach.behind)
            continue;
        Transfer transfer{.period = to - from};
        std::vector<double> cosines, sines;
        for (const auto& line : profiles.lines) {
            LeastSquares one(3);
            int points = 0;
            for (const auto& point : line) {
                const double s = point.u - chirp.start;
                if (s < from || s >= to)
                    continue;
                const double angle = 2 * pi * phase.turns(s);
                one.add(std::array{1.0, std::cos(angle), std::sin(angle)},
                        point.height - tilt.u * point.u - tilt.v * point.v);
                ++points;
            }
            const auto solution =
                points >= 4 && points >= least_share * (to - from) / profiles.spacing ? one.solve() : std::nullopt;
            cosines.push_back(solution ? solution->unknowns[1] : surface::undefined);
            sines.push_back(solution ? solution->unknowns[2] : surface::undefined);
        }
        const Mean cosine = mean_of(cosines), sine = mean_of(sines);
        const double amplitude = std::hypot(cosine.mean, sine.mean);
        transfer.ratio = amplitude / chirp.amplitude;
        transfer.standard_error = std::hypot(cosine.mean * cosine.standard_error, sine.mean * sine.standard_error) /
                                  amplitude / chirp.amplitude;
        transfers.push_back(transfer);
    }
    return transfers;
}

std::vector<Transfer> star_transfer(const HeightMap& map, const Star& star) {
    constexpr int rings = 12;
    constexpr double least_points = 4, half_width = 0.05;
    constexpr double inner_share = 0.9; // share of the radius: pixels and focus windows round the rim
    const double outermost = inner_share * star.radius / (1 + half_width);
    const double innermost = least_points * std::max(map.pitch_x, map.pitch_y) * star.petals / (2 * pi);
    std::vector<Transfer> transfers;
    if (!(innermost < outermost))
        return transfers;
    for (int ring = 0; ring < rings; ++ring) {
        const double radius = outermost * std::pow(innermost / outermost, ring / (rings - 1.0));
        Transfer transfer{.period = 2 * pi * radius / star.petals};
        const double inner = radius * (1 - half_width), outer = radius * (1 + half_width);
        // The number of harmonics that the points resolve.
        const double points_a_period = transfer.period / std::max(map.pitch_x, map.pitch_y);
        const std::size_t harmonics = points_a_period > 20 ? 3 : points_a_period > 12 ? 2 : 1;
        const auto functions = [&](double x, double y) {
            std::vector<double> values{1.0, x, y};
            const double azimuth = std::atan2(y, x) * star.petals;
            for (std::size_t k = 0; k < harmonics; ++k) {
                const double angle = static_cast<double>(2 * k + 1) * azimuth;
                values.insert(values.end(), {std::cos(angle), std::sin(angle)});
            }
            return values;
        };
        LeastSquares squares(3 + 2 * harmonics);
        double count = 0;
        const auto for_points = [&](const auto& visit) {
            for (int row = 0; row < map.rows(); ++row)
                for (int column = 0; column < map.columns(); ++column) {
                    const double x = star.frame.u(map.x(column), map.y(row));
                    const double y = star.frame.v(map.x(column), map.y(row));
                    const double r = std::hypot(x, y);
                    if (const double z = map.height(column, row); r >= inner && r <= outer && std::isfinite(z))
                        visit(functions(x, y), z, map.height.index(column, row));
                }
        };
        for_points([&](const std::vector<double>& values, double z, std::size_t) {
            squares.add(values, z);
            count += 1;
        });
        const double expected = pi * (outer * outer - inner * inner) / (map.pitch_x * map.pitch_y);
        const auto solution = count >= 0.5 * expected ? squares.solve() : std::nullopt;
        if (solution) {
            Grid<double> residues(map.columns(), map.rows(), surface::undefined);
            for_points([&](const std::vector<double>& values, double z, std::size_t place) {
                for (std::size_t k = 0; k < values.size(); ++k)
                    z -= values[k] * solution->unknowns[k];
                residues.values[place] = z;
            });
            const double nominal = 2 * std::abs(star.height) / pi;
            transfer.ratio = std::hypot(solution->unknowns[3], solution->unknowns[4]) / nominal;
            const auto covariance = fit_covariance(residues, *solution, [&](std::size_t place, std::span<double> into) {
                const auto columns = static_cast<std::size_t>(map.columns());
                const double px = map.x(static_cast<int>(place % columns)),
                             py = map.y(static_cast<int>(place / columns));
                std::ranges::copy(functions(star.frame.u(px, py), star.frame.v(px, py)), into.begin());
            });
            transfer.standard_error = std::max(covariance.standard_error(3), covariance.standard_error(4)) / nominal;
        }
        transfers.push_back(transfer);
    }
    return transfers;
}

std::optional<double> period_at_half(std::vector<Transfer> transfers) {
    std::erase_if(transfers, [](const Transfer& one) { return !std::isfinite(one.ratio); });
    std::ranges::sort(transfers, std::ranges::greater(), &Transfer::period);
    // The search starts at the largest ratio, as noise may reduce that of a longer period.
    transfers.erase(transfers.begin(), std::ranges::max_element(transfers, {}, &Transfer::ratio));
    if (transfers.empty() || transfers.front().ratio < 0.5)
        return std::nullopt;
    for (std::size_t k = 1; k < transfers.size(); ++k) {
        const Transfer &above = transfers[k - 1], &below = transfers[k];
        if (below.ratio < 0.5)
            return above.period + (below.period - above.period) * (above.ratio - 0.5) / (above.ratio - below.ratio);
    }
    return std::nullopt;
}

} // namespace vkfv::dimensions
