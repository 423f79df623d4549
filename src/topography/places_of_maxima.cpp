#include "topography/places_of_maxima.hpp"

#include "core/threads/parallel_list.hpp"
#include "topography/axial_average.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace vkfv::topography {
namespace {

// The logarithm of the ratio of neighbouring widths of PlacesByWidth.
const double step_of_logarithms = 0.25 * std::log(2.0);
constexpr int widths_on_a_side = 6;

// An end is felt as far as it moves the maxima of curves 1.7 times as wide as the stack's by a hundredth of a step.
// Further away heights are those of the stack's width, and need no width of their own curve.
constexpr int widths_wider = 3;
constexpr double negligible = 0.01; // steps

// The weights of single images in a point of the curve after both averages.
struct Row {
    std::size_t first;
    std::vector<double> weights;
};

// The rows of the points from an end on, as many as are needed to find maxima.
std::vector<Row> rows_near_the_end(const std::vector<double>& weights, int images, int points) {
    const int reach = 2 * (static_cast<int>(weights.size()) - 1);
    std::vector<Row> rows;
    rows.reserve(static_cast<std::size_t>(points));
    for (int at = 0; at < points; ++at) {
        const auto all = twice_averaged(weights, at, images);
        const int first = std::max(0, at - reach), last = std::min(images - 1, at + reach);
        rows.push_back(
            {.first = static_cast<std::size_t>(first), .weights = {all.begin() + first, all.begin() + last + 1}});
    }
    return rows;
}

// A Gaussian after both averages; its values are computed when they are asked for.
class AveragedGaussian {
  public:
    AveragedGaussian(const std::vector<Row>& rows, int images, double place, double width)
        : rows_(rows), values_(rows.size(), std::numeric_limits<double>::quiet_NaN()) {
        const auto count = std::min(static_cast<std::size_t>(images), rows.back().first + rows.back().weights.size());
        for (std::size_t image = 0; image < count; ++image) {
            const double distance = (static_cast<double>(image) - place) / width;
            singles_.push_back(std::exp(-0.5 * distance * distance));
        }
    }

    double curve_value(int at) const {
        double& value = values_[static_cast<std::size_t>(at)];
        if (std::isnan(value)) {
            const Row& row = rows_[static_cast<std::size_t>(at)];
            value = std::inner_product(row.weights.begin(), row.weights.end(),
                                       singles_.begin() + static_cast<std::ptrdiff_t>(row.first), 0.0);
        }
        return value;
    }

    // The point of the largest value, searched from this point on: the curve has one maximum.
    int summit_from(int at) const {
        const int last = static_cast<int>(values_.size()) - 1;
        while (at < last && curve_value(at + 1) > curve_value(at)) {
            ++at;
        }
        while (at > 0 && curve_value(at - 1) >= curve_value(at)) {
            --at;
        }
        return at;
    }

  private:
    const std::vector<Row>& rows_;
    mutable std::vector<double> values_; // NaN: not yet computed
    std::vector<double> singles_;
};

// The distance from the end, in steps, up to which it is felt; at most the middle of the scan.
double end_felt_to(const std::vector<double>& weights, int images) {
    return std::min(2.0 * (static_cast<double>(weights.size()) - 1), 0.5 * (images - 1));
}

// The maxima of curves whose places go from the end to where it is not felt, in ascending order of `found`. Maxima at
// the first point are left out, as the scan ends there.
std::vector<MaximumNearEnd> maxima_near_the_end(const std::vector<Row>& rows, int images, double last,
                                                double curve_width, const PeakFinder& finder) {
    // With places this close, linear interpolation errs by a thousandth of a step.
    constexpr double finest = 0.05; // steps
    constexpr int most_places = 240;
    const int places = std::min(most_places, static_cast<int>(std::ceil(last / finest)));
    focus::f64::FocusPlan plan{};
    plan.peak = static_cast<int>(finder.method);
    std::vector<MaximumNearEnd> maxima;
    int at = 0;
    for (int k = 0; k <= places; ++k) {
        const double place = last * k / places;
        const AveragedGaussian curve(rows, images, place, curve_width);
        at = curve.summit_from(at);
        const int range = std::min({finder.range, at, static_cast<int>(rows.size()) - 1 - at});
        const auto fit = focus::f64::locate_peak(curve, plan, at, range);
        if (!fit.found) {
            continue;
        }
        const double largest = curve.curve_value(at);
        const double bend = (2 * largest - curve.curve_value(at - 1) - curve.curve_value(at + 1)) / largest;
        MaximumNearEnd maximum{
            .place = place, .found = at + fit.offset, .curvature = curvature_at_maximum(bend, fit.offset), .image = at};
        if (k == places) {
            maximum.found = last;
        }
        if (maximum.found <= last && (maxima.empty() || maximum.found > maxima.back().found)) {
            maxima.push_back(maximum);
        }
    }
    return maxima;
}

std::vector<double> positions(const std::vector<double>& weights, int images) {
    std::vector<double> places;
    places.reserve(static_cast<std::size_t>(images));
    for (const AveragedPoint& point : averaged_points(weights, images)) {
        places.push_back(point.position);
    }
    return places;
}

// Interpolates linearly between values at integers.
double on_line(const std::vector<double>& line, double at) {
    const auto before = std::min(static_cast<std::size_t>(std::max(0.0, at)), line.size() - 2);
    return line[before] + (at - static_cast<double>(before)) * (line[before + 1] - line[before]);
}

// The index of the maximum before a place that is not before the first of them.
std::size_t maximum_before(const std::vector<MaximumNearEnd>& maxima, double found) {
    const auto after = std::ranges::upper_bound(maxima, found, {}, &MaximumNearEnd::found);
    return static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(after - maxima.begin() - 1, 0, static_cast<std::ptrdiff_t>(maxima.size()) - 2));
}

double between_maxima(const std::vector<MaximumNearEnd>& maxima, double found, double MaximumNearEnd::*figure) {
    if (maxima.size() == 1) {
        return maxima.front().*figure;
    }
    const std::size_t k = maximum_before(maxima, found);
    const double share = (found - maxima[k].found) / (maxima[k + 1].found - maxima[k].found);
    return std::lerp(maxima[k].*figure, maxima[k + 1].*figure, std::min(share, 1.0));
}

// The place of a curve whose maximum is found at `found`, in steps from the end; line: averaged_points().
double place_near_the_end(const std::vector<MaximumNearEnd>& maxima, const std::vector<double>& line, double found) {
    const MaximumNearEnd& first = maxima.front();
    return found < first.found ? std::max(0.0, on_line(line, found) + first.place - on_line(line, first.found))
                               : between_maxima(maxima, found, &MaximumNearEnd::place);
}

int points_near_the_end(const std::vector<double>& weights, int images, const PeakFinder& finder) {
    const int radius = static_cast<int>(weights.size()) - 1;
    return std::min(images, 2 * radius + std::max(radius, finder.range) + 2);
}

} // namespace

std::vector<double> places_of_maxima(const std::vector<double>& weights, int images, double curve_width,
                                     const PeakFinder& finder) {
    std::vector<double> places = positions(weights, images);
    if (!(curve_width > 0) || weights.size() == 1) {
        return places;
    }
    const double last = end_felt_to(weights, images);
    const auto maxima =
        maxima_near_the_end(rows_near_the_end(weights, images, points_near_the_end(weights, images, finder)), images,
                            last, curve_width, finder);
    if (maxima.empty()) {
        return places;
    }
    // The other end is the mirror image of this one.
    const std::vector<double> line = places;
    for (int at = 0; 2 * at < images - 1 && at < last; ++at) {
        const double place = place_near_the_end(maxima, line, at);
        places[static_cast<std::size_t>(at)] = place;
        places[static_cast<std::size_t>(images - 1 - at)] = images - 1 - place;
    }
    return places;
}

double curvature_at_maximum(double bend, double offset) {
    // The neighbours of a Gaussian's value at the distance `offset` from its maximum, over that value, add up to
    // 2 exp(-c / 2) cosh(c offset). Newton's method for its logarithm, which falls from 0 on and is nearly straight.
    if (!(bend > 0) || !(bend < 2)) {
        return 0;
    }
    const double logarithm = std::log1p(-0.5 * bend), distance = std::clamp(offset, -0.5, 0.5);
    double curvature = -2 * logarithm;
    constexpr int rounds = 20;
    for (int round = 0; round < rounds; ++round) {
        const double slope = -0.5 + distance * std::tanh(curvature * distance);
        const double change = (-0.5 * curvature + std::log(std::cosh(curvature * distance)) - logarithm) / slope;
        curvature -= change;
        if (std::abs(change) < 1e-12 * curvature) {
            break;
        }
    }
    return curvature;
}

PlacesByWidth::PlacesByWidth(const std::vector<double>& weights, int images, double curve_width,
                             const PeakFinder& finder)
    : images_(images) {
    if (!(curve_width > 0) || weights.size() == 1) {
        return;
    }
    last_ = end_felt_to(weights, images);
    line_ = positions(weights, images);
    const auto rows = rows_near_the_end(weights, images, points_near_the_end(weights, images, finder));
    by_width_.resize(2 * widths_on_a_side + 1);
    parallel_items(static_cast<int>(by_width_.size()), [&](int k) {
        const double width = curve_width * std::exp((k - widths_on_a_side) * step_of_logarithms);
        by_width_[static_cast<std::size_t>(k)] = maxima_near_the_end(rows, images, last_, width, finder);
    });
    // Very wide curves have no maxima here, since all of them move to the end itself.
    by_width_.erase(std::ranges::find_if(by_width_, [](const auto& maxima) { return maxima.empty(); }),
                    by_width_.end());
    if (by_width_.size() <= widths_on_a_side) {
        by_width_.clear();
        return;
    }
    const std::size_t wider = std::min(by_width_.size() - 1, static_cast<std::size_t>(widths_on_a_side + widths_wider));
    const auto& maxima = by_width_[wider];
    const auto moved = std::find_if(maxima.rbegin(), maxima.rend(), [&](const MaximumNearEnd& maximum) {
        return std::abs(maximum.place - on_line(line_, maximum.found)) > negligible;
    });
    last_ = moved == maxima.rend() ? 0 : moved->found;
}

double PlacesByWidth::from_the_end(double at) const {
    return std::min(at, images_ - 1 - at);
}

bool PlacesByWidth::feels_an_end(double at) const {
    return !by_width_.empty() && from_the_end(at) < last_;
}

PlacesByWidth::Width PlacesByWidth::width(int image, double offset, double curvature) const {
    const double at = image + offset;
    if (!feels_an_end(at) || !(curvature > 0)) {
        return {};
    }
    const double found = from_the_end(at);
    const int nearest_image = found == at ? image : images_ - 1 - image;
    struct Known {
        double logarithm, curvature; // the curvature is a logarithm, too
    };
    std::vector<Known> known;
    known.reserve(by_width_.size());
    for (std::size_t k = 0; k < by_width_.size(); ++k) {
        const double here = found < by_width_[k].front().found ? 0 : curvature_of(k, nearest_image, found);
        if (here > 0) {
            known.push_back({.logarithm = (static_cast<double>(k) - widths_on_a_side) * step_of_logarithms,
                             .curvature = std::log(here)});
        }
    }
    if (known.size() < 2) {
        return {};
    }
    const double wanted = std::log(curvature);
    std::optional<Width> nearest;
    for (std::size_t k = 1; k < known.size(); ++k) {
        const Known& narrow = known[k - 1];
        const Known& wide = known[k];
        const double fall = narrow.curvature - wide.curvature;
        if (fall > 0 && wanted <= narrow.curvature && wanted >= wide.curvature) {
            const double logarithm = std::lerp(narrow.logarithm, wide.logarithm, (narrow.curvature - wanted) / fall);
            if (!nearest || std::abs(logarithm) < std::abs(nearest->logarithm)) {
                nearest = Width{.logarithm = logarithm, .weight = std::pow(fall / step_of_logarithms, 2)};
            }
        }
    }
    if (nearest) {
        return *nearest;
    }
    const bool narrower = wanted > known.front().curvature;
    const Known& one = narrower ? known[0] : known[known.size() - 2];
    const Known& other = narrower ? known[1] : known.back();
    return {.logarithm = narrower ? one.logarithm : other.logarithm,
            .weight = std::pow((one.curvature - other.curvature) / step_of_logarithms, 2)};
}

// The curvature by three values depends on the three chosen, and jumps where the largest value becomes another: so
// curves with the largest value at the same image are compared.
double PlacesByWidth::curvature_of(std::size_t width, int image, double found) const {
    const auto& maxima = by_width_[width];
    const auto first = std::ranges::lower_bound(maxima, image, {}, &MaximumNearEnd::image);
    const auto end = std::ranges::upper_bound(maxima, image, {}, &MaximumNearEnd::image);
    if (end - first < 2) {
        return between_maxima(maxima, found, &MaximumNearEnd::curvature);
    }
    const auto later = std::ranges::upper_bound(maxima, found, {}, &MaximumNearEnd::found);
    const auto after = std::clamp(later, first + 1, end - 1);
    const MaximumNearEnd &before = *(after - 1), &next = *after;
    return std::lerp(before.curvature, next.curvature, (found - before.found) / (next.found - before.found));
}

double PlacesByWidth::place_of(std::size_t width, double found) const {
    return place_near_the_end(by_width_[width], line_, found);
}

double PlacesByWidth::place(double at, double logarithm) const {
    const double found = from_the_end(at);
    const double width =
        std::clamp(widths_on_a_side + logarithm / step_of_logarithms, 0.0, static_cast<double>(by_width_.size() - 1));
    const auto narrow = std::min(static_cast<std::size_t>(width), by_width_.size() - 2);
    const double place =
        std::lerp(place_of(narrow, found), place_of(narrow + 1, found), width - static_cast<double>(narrow));
    return 2 * at < images_ - 1 ? place : images_ - 1 - place;
}

} // namespace vkfv::topography
