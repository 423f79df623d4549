// Finds the edge of a region along a line, for example of a pupil.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

namespace vkfv::optics {

// Two places on a line between which the edge lies.
struct Bracket {
    double inside;
    double outside;
};

// Narrows a bracket to the width `enough`, with excess() <= 0 inside and > 0 outside. Where the excess is finite on
// both sides, the next place follows from linear interpolation, else it is the middle. I. F. D. Oliveira, R. H. C.
// Takahashi, "An enhancement of the bisection method average performance preserving minmax optimality", ACM Trans.
// Math. Softw. 47 (2021), with its k1 = 0.2 / width, k2 = 2 and n0 = 1: never more than one step beyond bisection, and
// few steps where excess() is smooth.
template <class Excess>
Bracket narrowed(Bracket bracket, double excess_inside, double excess_outside, const Excess& excess, double enough) {
    auto& [inside, outside] = bracket;
    const double width = outside - inside;
    double reach = 2 * width; // width that bisection would have reached, with one step to spare
    while (outside - inside > enough) {
        const double middle = 0.5 * (inside + outside);
        double next = middle;
        if (std::isfinite(excess_inside) && std::isfinite(excess_outside)) {
            const double now = outside - inside;
            const double line = (excess_outside * inside - excess_inside * outside) / (excess_outside - excess_inside);
            const double nudge = 0.2 / width * now * now;
            const double towards = std::copysign(std::min(nudge, std::abs(middle - line)), middle - line);
            const double room = std::max(0.0, 0.5 * (reach - now));
            next = std::clamp(line + towards, middle - room, middle + room);
        }
        if (!(next > inside && next < outside)) {
            next = middle;
            if (!(next > inside && next < outside)) {
                break; // no number lies between the two
            }
        }
        const double here = excess(next);
        (here <= 0 ? inside : outside) = next;
        (here <= 0 ? excess_inside : excess_outside) = here;
        reach *= 0.5;
    }
    return bracket;
}

// The largest t of [0, limit] with excess(t) <= 0, to rounding: the search goes inward in steps of limit / 32, then by
// bisection. A region that lies between two steps, and not at 0, is missed. None if no step is inside. excess(t): the
// distance beyond the edge in any unit; a continuous function makes the search fast, infinity means outside without a
// measure. bisections: halvings of a step; 45 of them leave rounding only.
template <class Excess>
std::optional<double> farthest(double limit, const Excess& excess, int bisections = 45) {
    constexpr int steps = 32;
    double beyond = 0; // excess at the previous step
    for (int step = steps; step >= 0; --step) {
        double inside = limit * step / steps;
        const double here = excess(inside);
        if (!(here <= 0)) {
            beyond = here;
            continue;
        }
        if (step == steps) {
            return inside;
        }
        double outside = limit * (step + 1) / steps;
        // The bisection reuses the narrowed bracket: it gives the same number with few calls of excess().
        const double enough = std::ldexp(outside - inside, -std::min(bisections, 46));
        const Bracket edge = narrowed({inside, outside}, here, beyond, excess, enough);
        for (int i = 0; i < bisections; ++i) {
            const double middle = 0.5 * (inside + outside);
            const bool holds = middle <= edge.inside || (middle < edge.outside && excess(middle) <= 0);
            (holds ? inside : outside) = middle;
        }
        return inside;
    }
    return std::nullopt;
}

} // namespace vkfv::optics
