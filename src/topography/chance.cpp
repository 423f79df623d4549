#include "topography/chance.hpp"

#include "core/threads/parallel_list.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <numeric>
#include <random>

namespace vkfv::topography {
namespace {

// The value that a further one exceeds at this rate: the k-th largest of n is exceeded with the probability k / (n +
// 1).
double exceeded_at_rate(std::vector<double> values, double rate) {
    const double count = static_cast<double>(values.size());
    const auto place = static_cast<std::ptrdiff_t>(std::clamp(std::floor(rate * (count + 1)), 1.0, count)) - 1;
    std::ranges::nth_element(values, values.begin() + place, std::greater<>());
    return values[static_cast<std::size_t>(place)];
}

} // namespace

Evidence evidence(const focus::f64::CurveRecord& curve, const focus::f64::SingleRecord& single, int images) {
    return {.unimodality = focus::f64::unimodality(curve), .order = focus::f64::order_shown(curve, single, images)};
}

Evidence evidence_of(const std::vector<double>& values, const std::vector<double>& singles) {
    auto curve = focus::f64::empty_curve();
    focus::f64::SingleRecord record{};
    for (std::size_t k = 0; k < values.size(); ++k) {
        curve = focus::f64::follow_shape(curve, values[k], static_cast<int>(k));
        record = focus::f64::follow_single(record, singles[k], static_cast<int>(k));
    }
    const bool inside = curve.highest > values.front() && curve.highest > values.back();
    return inside ? evidence(curve, record, static_cast<int>(values.size())) : Evidence{};
}

// The limit that a share `rate` of random orders exceeds. Unimodality gets half of the rate; the order shown gets the
// part that random orders above the limit of unimodality leave: all of it where averages along z make every curve
// unimodal.
ChanceLimit limit_of(const std::vector<Evidence>& by_chance, double rate, int images) {
    std::vector<double> unimodality, order;
    std::ranges::transform(by_chance, std::back_inserter(unimodality), &Evidence::unimodality);
    ChanceLimit limit{.least = {.unimodality = exceeded_at_rate(unimodality, rate / 2)}};
    if (images <= few_images) {
        limit.least.unimodality = std::min(limit.least.unimodality, most_unimodality_asked);
    }
    double above = 0;
    for (const Evidence& found : by_chance) {
        const bool unimodal = found.unimodality > limit.least.unimodality;
        above += unimodal ? 1 : 0;
        order.push_back(unimodal ? 0 : found.order);
    }
    const auto orders = static_cast<double>(by_chance.size());
    limit.least.order = exceeded_at_rate(order, std::max(rate / 2, rate - above / orders));
    above += static_cast<double>(std::ranges::count_if(order, [&](double found) { return found > limit.least.order; }));
    limit.rate = (above + 1) / (orders + 1); // plus one, as the next order may exceed it
    return limit;
}

// Number of random orders for a limit at this rate. The next value exceeds the largest of n with the probability 1 / (n
// + 1), with as large a relative error: some more are drawn where the limit is close to the evidence of curves of few
// images.
int random_orders(double rate, bool cheap, int images) {
    constexpr int many_images = 64;
    constexpr double most = 100000;
    const double times = cheap ? 32 : images <= many_images ? 4 : 1;
    return static_cast<int>(std::clamp(std::ceil(times / rate), 250.0, most));
}

std::vector<int> images_in_order(int images) {
    std::vector<int> order(static_cast<std::size_t>(images));
    std::iota(order.begin(), order.end(), 0);
    return order;
}

std::vector<int> random_order(int images, std::uint64_t seed) {
    std::vector<int> order = images_in_order(images);
    std::mt19937_64 random(seed);
    for (std::size_t last = order.size(); last > 1; --last) {
        std::swap(order[last - 1], order[random() % last]);
    }
    return order;
}

Evidence mean_evidence(const std::vector<std::vector<double>>& curves, const std::vector<int>& order) {
    Evidence mean;
    std::vector<double> values(order.size());
    for (const auto& curve : curves) {
        std::ranges::transform(order, values.begin(),
                               [&](int image) { return curve[static_cast<std::size_t>(image)]; });
        const Evidence found = evidence_of(values, values);
        mean.unimodality += found.unimodality / static_cast<double>(curves.size());
        mean.order += found.order / static_cast<double>(curves.size());
    }
    return mean;
}

ChanceLimit limit_of_stack(const std::vector<std::vector<double>>& curves, double rate) {
    const int images = static_cast<int>(curves.front().size());
    const double of_stacks = rate_of_stacks * rate;
    // Unimodality and order shown get half of the rate each, at which the largest of 2 / rate values is exceeded.
    constexpr double most = 100000;
    const auto orders = static_cast<std::size_t>(std::clamp(std::ceil(2 / of_stacks), 250.0, most));
    std::vector<Evidence> by_chance(orders);
    parallel_items(static_cast<int>(orders), [&](int sample) {
        by_chance[static_cast<std::size_t>(sample)] =
            mean_evidence(curves, random_order(images, static_cast<std::uint64_t>(sample)));
    });
    return limit_of(by_chance, of_stacks, images);
}

} // namespace vkfv::topography
