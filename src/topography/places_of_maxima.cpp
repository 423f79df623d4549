#include "topography/places_of_maxima.hpp"

#include "topography/axial_average.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace vkfv::topography {
namespace {

// Of a curve in the middle of `place`, both in steps.
struct Maximum {
    double place;
    double found;
};

// By the Gaussian through three values; none at an end.
std::optional<double> maximum_of(const std::vector<double>& curve) {
    const auto largest = std::ranges::max_element(curve);
    if (largest == curve.begin() || largest + 1 == curve.end()) {
        return std::nullopt;
    }
    const double before = std::log(largest[-1]), here = std::log(largest[0]), after = std::log(largest[1]);
    return static_cast<double>(largest - curve.begin()) + 0.5 * (before - after) / (before - 2 * here + after);
}

// Of curves from the end to where it is not felt, or the middle of the scan.
std::vector<Maximum> maxima_near_the_end(const std::vector<double>& weights, int images, double curve_width) {
    const int reach = 2 * (static_cast<int>(weights.size()) - 1);
    std::vector<std::vector<double>> averages;
    for (int at = 0; at < std::min(images, 2 * reach + 2); ++at) {
        averages.push_back(twice_averaged(weights, at, images));
    }
    const double last = std::min<double>(reach, 0.5 * (images - 1));
    constexpr double finest = 0.25; // steps; finer than the averages change
    constexpr int most_places = 48;
    const int places = std::min(most_places, static_cast<int>(std::ceil(last / finest)));
    std::vector<Maximum> maxima;
    for (int k = 0; k < places; ++k) {
        const double place = last * k / places;
        std::vector<double> single, curve;
        for (int image = 0; image < images; ++image) {
            const double distance = (image - place) / curve_width;
            single.push_back(std::exp(-0.5 * distance * distance));
        }
        for (const auto& shares : averages) {
            curve.push_back(std::inner_product(shares.begin(), shares.end(), single.begin(), 0.0));
        }
        const auto found = maximum_of(curve);
        if (found && *found < last && (maxima.empty() || *found > maxima.back().found)) {
            maxima.push_back({.place = place, .found = *found});
        }
    }
    if (!maxima.empty()) {
        maxima.push_back({.place = last, .found = last});
    }
    return maxima;
}

} // namespace

std::vector<double> places_of_maxima(const std::vector<double>& weights, int images, double curve_width) {
    std::vector<double> places;
    for (const AveragedPoint& point : averaged_points(weights, images)) {
        places.push_back(point.position);
    }
    if (!(curve_width > 0) || weights.size() == 1) {
        return places;
    }
    const auto maxima = maxima_near_the_end(weights, images, curve_width);
    if (maxima.empty()) {
        return places;
    }
    const auto of_a_line = [line = places](double at) {
        const auto before = static_cast<std::size_t>(at);
        return line[before] + (at - static_cast<double>(before)) * (line[before + 1] - line[before]);
    };
    // The other half is the mirror image of the first.
    for (int at = 0; 2 * at < images - 1 && at < maxima.back().found; ++at) {
        const auto after = std::ranges::upper_bound(maxima, static_cast<double>(at), {}, &Maximum::found);
        double place = 0;
        if (after == maxima.begin()) {
            place = of_a_line(at) + after->place - of_a_line(after->found);
        } else {
            const auto before = after - 1;
            place = std::lerp(before->place, after->place, (at - before->found) / (after->found - before->found));
        }
        places[static_cast<std::size_t>(at)] = place;
        places[static_cast<std::size_t>(images - 1 - at)] = images - 1 - place;
    }
    return places;
}

} // namespace vkfv::topography
