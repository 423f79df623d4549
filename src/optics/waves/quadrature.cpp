#include "optics/waves/quadrature.hpp"

#include "core/mathematics/units.hpp"

#include <cmath>
#include <map>
#include <memory>
#include <mutex>

namespace vkfv::optics {

namespace {

// A node of the rule over [-1, 1]; its weight is 2 / divisor.
struct UnitNode {
    double place = 0;
    double divisor = 0;
};

// The roots of Legendre's polynomial by Newton's method, which converges from the initial values of Abramowitz and
// Stegun, section 22.16.6; the weights are 2 / ((1 - x^2) P'(x)^2) (25.4.29).
std::vector<UnitNode> unit_nodes(int count) {
    std::vector<UnitNode> nodes;
    for (int k = 0; k < count; ++k) {
        double x = -std::cos(pi * (k + 0.75) / (count + 0.5));
        double slope = 1;
        double last = 1;
        for (int step = 0; step < 8 && std::abs(last) > 1e-15; ++step) {
            double before = 0;
            double value = 1;
            for (int n = 1; n <= count; ++n) {
                const double next = ((2 * n - 1) * x * value - (n - 1) * before) / n;
                before = value;
                value = next;
            }
            slope = count * (before - x * value) / ((1 - x) * (1 + x));
            last = value / slope;
            x -= last;
        }
        nodes.push_back({.place = x, .divisor = (1 - x) * (1 + x) * slope * slope});
    }
    return nodes;
}

// Rules of few nodes are cached, because an aberrated pupil needs the same rule ten thousand times. They take at most 2
// MB.
std::shared_ptr<const std::vector<UnitNode>> kept_unit_nodes(int count) {
    constexpr int most_kept = 512;
    if (count > most_kept) {
        return std::make_shared<const std::vector<UnitNode>>(unit_nodes(count));
    }
    static std::mutex mutex;
    static std::map<int, std::shared_ptr<const std::vector<UnitNode>>> kept;
    const std::scoped_lock lock(mutex);
    auto& rule = kept[count];
    if (!rule) {
        rule = std::make_shared<const std::vector<UnitNode>>(unit_nodes(count));
    }
    return rule;
}

} // namespace

std::vector<QuadratureNode> gauss_legendre(int count, double from, double to) {
    const auto unit = kept_unit_nodes(count);
    const double half = 0.5 * (to - from);
    std::vector<QuadratureNode> nodes;
    nodes.reserve(unit->size());
    for (const UnitNode& node : *unit) {
        nodes.push_back({.place = from + half * (1 + node.place), .weight = half * 2 / node.divisor});
    }
    return nodes;
}

} // namespace vkfv::optics
