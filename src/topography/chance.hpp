// Evidence that distinguishes a focus curve, and a stack as a whole, from images in random order.
#pragma once

#include "focus/focus.hpp"

#include <cstdint>
#include <vector>

namespace vkfv::topography {

// Curves of few images are often as unimodal as possible by chance: no more than most_unimodality_asked is demanded
// then.
inline constexpr int few_images = 14;
inline constexpr double most_unimodality_asked = 0.8;

// Evidence against chance (curve.glsl): unimodality discriminates best where there are few images or little noise, the
// order shown elsewhere.
struct Evidence {
    double unimodality = 0;
    double order = 0;
};

Evidence evidence(const focus::f64::CurveRecord& curve, const focus::f64::SingleRecord& single, int images);

// The evidence of a whole curve; singles: values of single images in the same order. Zero where the largest value
// stands at an end.
Evidence evidence_of(const std::vector<double>& values, const std::vector<double>& singles);

// The limit of chance. Evidence that exceeds either value is not by chance.
struct ChanceLimit {
    Evidence least;
    double rate = 1; // share of the random orders that exceed the limit

    bool exceeded_by(const Evidence& found) const {
        return found.unimodality > least.unimodality || found.order > least.order;
    }
};

// The limit that this share of curves in random order exceeds, except for most_unimodality_asked. by_chance: their
// evidence.
ChanceLimit limit_of(const std::vector<Evidence>& by_chance, double rate, int images);

// The number of random orders needed for a limit at `rate`; larger if an order is cheap.
int random_orders(double rate, bool cheap, int images);

std::vector<int> images_in_order(int images);

// A random order of the images that depends on the seed alone.
std::vector<int> random_order(int images, std::uint64_t seed);

// The evidence of a stack as a whole: its mean at many places. All points see the images in the same order: where the
// specimen is smooth their curves are alike, and one random order in a hundred lets a fifth of all points pass a limit
// that a share of 0.003 passes on average over many orders. So the mean must exceed chance too, judged by random orders
// of the whole stack.
Evidence mean_evidence(const std::vector<std::vector<double>>& curves, const std::vector<int>& order);

// Share of the random orders of a whole stack that exceed its limit, over the rate of single points: the share of
// measured points, averaged over twenty random orders, then exceeds a hundredth in fewer than one stack of a hundred,
// however alike its points are.
inline constexpr double rate_of_stacks = 0.1;

// The limit of a stack's mean evidence. curves: of single images at some places, in any one order; rate: of single
// points.
ChanceLimit limit_of_stack(const std::vector<std::vector<double>>& curves, double rate);

} // namespace vkfv::topography
