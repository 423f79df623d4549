// What tells a focus curve, and a stack as a whole, from images in random order.
#pragma once

#include "focus/focus.hpp"

#include <cstdint>
#include <vector>

namespace vkfv::topography {

// Curves of few images are often as unimodal as a curve can be by chance: no more than this is asked of them.
inline constexpr int few_images = 14;
inline constexpr double most_unimodality_asked = 0.8;

// What tells a curve from chance (curve.glsl): unimodality best where there are few images or little noise, the order
// shown elsewhere.
struct Evidence {
    double unimodality = 0;
    double order = 0;
};

Evidence evidence(const focus::f64::CurveRecord& curve, const focus::f64::SingleRecord& single, int images);

// Of a whole curve; singles: of single images in the same order. Nothing where the largest value stands at an end.
Evidence evidence_of(const std::vector<double>& values, const std::vector<double>& singles);

// No matter of chance is what exceeds one or the other.
struct ChanceLimit {
    Evidence least;
    double rate = 1; // of the random orders that do

    bool exceeded_by(const Evidence& found) const {
        return found.unimodality > least.unimodality || found.order > least.order;
    }
};

// by_chance: of curves in random order. This share of them exceeds the limit, but for most_unimodality_asked.
ChanceLimit limit_of(const std::vector<Evidence>& by_chance, double rate, int images);

// How many orders tell what a share of `rate` exceeds, the more the less an order costs.
int random_orders(double rate, bool cheap, int images);

std::vector<int> images_in_order(int images);

// An order that the seed alone decides.
std::vector<int> random_order(int images, std::uint64_t seed);

// A stack as a whole. Its points see the same images in the same order: where the specimen is smooth their curves are
// alike, and one random order in a hundred lets a fifth of all points pass a limit that a share of 0.003 passes in the
// mean over many orders. So the mean evidence of many places must be no matter of chance either, judged by random
// orders of the whole stack.
Evidence mean_evidence(const std::vector<std::vector<double>>& curves, const std::vector<int>& order);

// Share of the random orders of a whole stack that exceed its limit, over the rate of single points: so twenty of them
// measure more than a hundredth in the mean in less than one stack of a hundred, however alike its points are.
inline constexpr double rate_of_stacks = 0.1;

// curves: of single images at some places, in any one order; rate: of single points.
ChanceLimit limit_of_stack(const std::vector<std::vector<double>>& curves, double rate);

} // namespace vkfv::topography
