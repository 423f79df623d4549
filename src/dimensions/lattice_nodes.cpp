#include "dimensions/lattice_nodes.hpp"

#include "core/mathematics/units.hpp"
#include "dimensions/least_squares.hpp"

#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

namespace vkfv::dimensions {

namespace {

// The Hann window of two periods about 0.
double hann(double distance, double period) {
    return std::abs(distance) < period ? 0.5 * (1 + std::cos(pi * distance / period)) : 0;
}

struct Phases {
    std::complex<double> along_u, along_v;
    double weight = 0, missing = 0; // sums of the window over measured and over other points
};

// The fundamental waves about the node at (u, v). mean: subtracted from all heights, so that points that are missing
// matter less.
Phases phases_at(const surface::HeightMap& map, const CrossGrating& grating, double u, double v, double mean) {
    const Frame& frame = grating.frame;
    const double reach = std::hypot(grating.pitch_u, grating.pitch_v);
    const double x = frame.x + u * std::cos(frame.angle) - v * std::sin(frame.angle);
    const double y = frame.y + u * std::sin(frame.angle) + v * std::cos(frame.angle);
    const auto first = [](double from, double pitch) { return static_cast<int>(std::ceil(from / pitch)); };
    const auto last = [](double to, double pitch) { return static_cast<int>(std::floor(to / pitch)); };
    Phases phases;
    for (int row = first(y - reach - map.y0, map.pitch_y); row <= last(y + reach - map.y0, map.pitch_y); ++row) {
        for (int column = first(x - reach - map.x0, map.pitch_x); column <= last(x + reach - map.x0, map.pitch_x);
             ++column) {
            const double du = frame.u(map.x(column), map.y(row)) - u, dv = frame.v(map.x(column), map.y(row)) - v;
            const double weight = hann(du, grating.pitch_u) * hann(dv, grating.pitch_v);
            if (weight == 0) {
                continue;
            }
            const bool inside = column >= 0 && column < map.columns() && row >= 0 && row < map.rows();
            const double height = inside ? map.height(column, row) - mean : surface::undefined;
            if (!std::isfinite(height)) {
                phases.missing += weight;
                continue;
            }
            phases.weight += weight;
            phases.along_u += weight * height * std::polar(1.0, -2 * pi * du / grating.pitch_u);
            phases.along_v += weight * height * std::polar(1.0, -2 * pi * dv / grating.pitch_v);
        }
    }
    return phases;
}

} // namespace

std::vector<LatticeNode> lattice_nodes(const surface::HeightMap& map, const CrossGrating& grating) {
    constexpr double square_angle = 1e-9, most_missing = 0.01;
    if (std::abs(grating.angle - 0.5 * pi) > square_angle) {
        return {};
    }
    double mean = 0, count = 0, farthest = 0;
    for (const double height : map.height.values) {
        if (std::isfinite(height)) {
            mean += height;
            count += 1;
        }
    }
    mean /= count;
    for (const int column : {0, map.columns() - 1}) {
        for (const int row : {0, map.rows() - 1}) {
            farthest = std::max(farthest, std::hypot(map.x(column) - grating.frame.x, map.y(row) - grating.frame.y));
        }
    }
    const int most_u = static_cast<int>(farthest / grating.pitch_u);
    const int most_v = static_cast<int>(farthest / grating.pitch_v);
    // A raised square stands at the origin, so that both waves have their maximum there, or their minimum if the depth
    // is negative.
    std::vector<LatticeNode> nodes;
    for (int j = -most_v; j <= most_v; ++j) {
        for (int i = -most_u; i <= most_u; ++i) {
            LatticeNode node{.u = i * grating.pitch_u, .v = j * grating.pitch_v};
            const Phases phases = phases_at(map, grating, node.u, node.v, mean);
            if (phases.weight > 0 && phases.missing <= most_missing * (phases.weight + phases.missing)) {
                node.off_u = -std::arg(phases.along_u) * grating.pitch_u / (2 * pi);
                node.off_v = -std::arg(phases.along_v) * grating.pitch_v / (2 * pi);
                nodes.push_back(node);
            }
        }
    }
    return nodes;
}

std::optional<LatticeMap> lattice_map(const std::vector<LatticeNode>& nodes) {
    constexpr std::size_t least_nodes = 4, unknowns = 3;
    if (nodes.size() < least_nodes) {
        return std::nullopt;
    }
    LeastSquares fit_u(unknowns), fit_v(unknowns);
    for (const auto& node : nodes) {
        const std::array<double, unknowns> functions = {1, node.u, node.v};
        fit_u.add(functions, node.off_u);
        fit_v.add(functions, node.off_v);
    }
    const auto u = fit_u.solve(), v = fit_v.solve();
    if (!u || !v) {
        return std::nullopt;
    }
    LatticeMap map{.rest = nodes};
    double squares = 0;
    for (auto& node : map.rest) {
        node.off_u -= u->unknowns[0] + u->unknowns[1] * node.u + u->unknowns[2] * node.v;
        node.off_v -= v->unknowns[0] + v->unknowns[1] * node.u + v->unknowns[2] * node.v;
        squares += node.off_u * node.off_u + node.off_v * node.off_v;
        map.largest_deviation = std::max(map.largest_deviation, std::hypot(node.off_u, node.off_v));
    }
    map.scatter = std::sqrt(squares / static_cast<double>(2 * (nodes.size() - unknowns)));
    map.amplification_u = 1 + u->unknowns[1];
    map.amplification_v = 1 + v->unknowns[2];
    const glm::dvec2 along_u(map.amplification_u, v->unknowns[1]), along_v(u->unknowns[2], map.amplification_v);
    map.perpendicularity =
        std::acos(glm::dot(along_u, along_v) / (glm::length(along_u) * glm::length(along_v))) - 0.5 * pi;
    map.amplification_error = map.scatter * std::sqrt(std::max(u->variances[1], v->variances[2]));
    map.perpendicularity_error = map.scatter * std::sqrt(u->variances[2] + v->variances[1]);
    return map;
}

} // namespace vkfv::dimensions
