#include "topography/places_of_maxima.hpp"

#include "topography/axial_average.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace vkfv::topography {
namespace {

// Of a curve in the middle of `place`, both in steps.
struct Maximum {
    double place;
    double found;
};

struct AveragedCurve {
    const std::vector<double>& values;
    double curve_value(int at) const { return values[static_cast<std::size_t>(at)]; }
};

// None at the beginning, where the scan ends, or at the end, where the values do.
std::optional<double> maximum_of(const std::vector<double>& curve, const PeakFinder& finder) {
    const auto at = static_cast<int>(std::ranges::max_element(curve) - curve.begin());
    const int range = std::min({finder.range, at, static_cast<int>(curve.size()) - 1 - at});
    focus::f64::FocusPlan plan{};
    plan.peak = static_cast<int>(finder.method);
    const auto fit = focus::f64::locate_peak(AveragedCurve{curve}, plan, at, range);
    return fit.found ? std::optional(at + fit.offset) : std::nullopt;
}

std::vector<double> averaged(const std::vector<double>& values, const std::vector<std::vector<Share>>& shares,
                             int count) {
    std::vector<double> result(static_cast<std::size_t>(count));
    for (int at = 0; at < count; ++at) {
        for (const auto& [image, weight] : shares[static_cast<std::size_t>(at)]) {
            result[static_cast<std::size_t>(at)] +=
                static_cast<double>(weight) * values[static_cast<std::size_t>(image)];
        }
    }
    return result;
}

// Of curves from the end to where it is not felt, or the middle of the scan.
std::vector<Maximum> maxima_near_the_end(const std::vector<double>& weights, int images, double curve_width,
                                         const PeakFinder& finder) {
    const int radius = static_cast<int>(weights.size()) - 1, reach = 2 * radius;
    const double last = std::min<double>(reach, 0.5 * (images - 1));
    // As many points as the maxima are found by, and what both averages take for them.
    const int points = std::min(images, reach + std::max(radius, finder.range) + 2);
    const int averages = std::min(images, points + radius), singles = std::min(images, averages + radius);
    std::vector<std::vector<Share>> shares;
    shares.reserve(static_cast<std::size_t>(averages));
    for (int at = 0; at < averages; ++at) {
        shares.push_back(axial_shares(weights, at, images));
    }
    // Straight lines between places so close leave out a thousandth of a step.
    constexpr double finest = 0.05; // steps
    constexpr int most_places = 240;
    const int places = std::min(most_places, static_cast<int>(std::ceil(last / finest)));
    std::vector<Maximum> maxima;
    for (int k = 0; k < places; ++k) {
        const double place = last * k / places;
        std::vector<double> curve(static_cast<std::size_t>(singles));
        for (int image = 0; image < singles; ++image) {
            const double distance = (image - place) / curve_width;
            curve[static_cast<std::size_t>(image)] = std::exp(-0.5 * distance * distance);
        }
        const auto found = maximum_of(averaged(averaged(curve, shares, averages), shares, points), finder);
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

std::vector<double> places_of_maxima(const std::vector<double>& weights, int images, double curve_width,
                                     const PeakFinder& finder) {
    std::vector<double> places;
    places.reserve(static_cast<std::size_t>(images));
    for (const AveragedPoint& point : averaged_points(weights, images)) {
        places.push_back(point.position);
    }
    if (!(curve_width > 0) || weights.size() == 1) {
        return places;
    }
    const auto maxima = maxima_near_the_end(weights, images, curve_width, finder);
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
            place = std::max(0.0, of_a_line(at) + after->place - of_a_line(after->found));
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
