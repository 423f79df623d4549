#include "surface/material_ratio.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <thread>

namespace vkfv::surface {
namespace {

// Sorts parts in parallel, one a thread, and merges them two by two.
void sort_downwards(std::span<double> values, unsigned threads) {
    constexpr std::size_t worth_a_thread = std::size_t{1} << 16;
    if (threads <= 1 || values.size() <= worth_a_thread) {
        std::ranges::sort(values, std::greater<>());
        return;
    }
    const std::size_t half = values.size() / 2;
    {
        const std::jthread first([&] { sort_downwards(values.first(half), threads / 2); });
        sort_downwards(values.subspan(half), threads - threads / 2);
    }
    std::inplace_merge(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(half), values.end(),
                       std::greater<>());
}

} // namespace

MaterialRatioCurve::MaterialRatioCurve(const HeightMap& map) {
    heights_.reserve(map.height.values.size());
    for (const double z : map.height.values)
        if (std::isfinite(z))
            heights_.push_back(z);
    sort_downwards(heights_, std::thread::hardware_concurrency());
}

double MaterialRatioCurve::height(double ratio) const {
    if (heights_.empty())
        return undefined;
    const double last = static_cast<double>(heights_.size() - 1);
    const double place = std::clamp(ratio * static_cast<double>(heights_.size()) - 0.5, 0.0, last);
    const auto k = static_cast<std::size_t>(place);
    const std::size_t next = std::min(k + 1, heights_.size() - 1);
    return std::lerp(heights_[k], heights_[next], place - static_cast<double>(k));
}

double MaterialRatioCurve::ratio(double height) const {
    if (heights_.empty())
        return undefined;
    const auto below = std::lower_bound(heights_.begin(), heights_.end(), height, std::greater<>());
    if (below == heights_.begin())
        return 0;
    if (below == heights_.end())
        return 1;
    const double above = *(below - 1);
    const double place = static_cast<double>(below - heights_.begin()) - 0.5 + (above - height) / (above - *below);
    return place / static_cast<double>(heights_.size());
}

double MaterialRatioCurve::material_volume(double height) const {
    double sum = 0;
    for (auto z = heights_.begin(); z != heights_.end() && *z > height; ++z)
        sum += *z - height;
    return sum / static_cast<double>(heights_.size());
}

double MaterialRatioCurve::void_volume(double height) const {
    double sum = 0;
    for (auto z = heights_.rbegin(); z != heights_.rend() && *z < height; ++z)
        sum += height - *z;
    return sum / static_cast<double>(heights_.size());
}

RatioParameters ratio_parameters(const MaterialRatioCurve& curve) {
    return {.sxp = curve.height(0.025) - curve.height(0.5), .sdc = curve.height(0.02) - curve.height(0.98)};
}

CoreParameters core_parameters(const MaterialRatioCurve& curve) {
    const std::vector<double>& z = curve.heights();
    if (z.size() < 4)
        return {undefined, undefined, undefined, undefined, undefined};
    const double count = static_cast<double>(z.size());
    const auto span = static_cast<std::size_t>(std::round(0.4 * count));
    std::size_t first = 0;
    for (std::size_t k = 1; k + span < z.size(); ++k)
        if (z[k] - z[k + span] < z[first] - z[first + span])
            first = k;

    const double points = static_cast<double>(span + 1);
    const double middle = static_cast<double>(first) + 0.5 * static_cast<double>(span); // index of the middle point
    double above_first = 0; // differences make a plateau's mean exact
    for (std::size_t k = first; k <= first + span; ++k)
        above_first += z[k] - z[first];
    const double mean = z[first] + above_first / points;
    double square = 0, product = 0;
    for (std::size_t k = first; k <= first + span; ++k) {
        const double from_middle = static_cast<double>(k) - middle;
        square += from_middle * from_middle;
        product += from_middle * (z[k] - mean);
    }
    // The k-th point lies at the ratio (k + 1/2) / count, so the curve's ends are at the indices -1/2 and count - 1/2.
    const double slope = product / square;
    const double upper = mean - slope * (middle + 0.5);
    const double lower = upper + slope * count;

    CoreParameters result;
    result.sk = upper - lower;
    result.smr1 = curve.ratio(upper);
    result.smr2 = curve.ratio(lower);
    if (result.smr1 > 0)
        result.spk = 2 * curve.material_volume(upper) / result.smr1;
    if (result.smr2 < 1)
        result.svk = 2 * curve.void_volume(lower) / (1 - result.smr2);
    return result;
}

} // namespace vkfv::surface
