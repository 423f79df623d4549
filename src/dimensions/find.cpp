#include "dimensions/find.hpp"

#include "core/mathematics/units.hpp"
#include "dimensions/find_sphere.hpp"
#include "dimensions/levels.hpp"
#include "dimensions/waves.hpp"
#include "surface/filter.hpp"

#include <algorithm>

namespace vkfv::dimensions {
namespace {

using surface::HeightMap;

// A step at one edge, or a strip between two edges, found in the mean heights along u in one direction.
struct Edges {
    Frame frame;                  // origin at the map's middle
    double first = 0, second = 0; // u of the edges
    double gain = 0;              // reduction of the sum of squares by the edges
    double height = 0;            // height between the edges above the rest
};

class MeanProfile {
  public:
    MeanProfile(const HeightMap& level, const Frame& frame, int bins)
        : count_(static_cast<std::size_t>(bins)), sum_(count_.size()), frame_(frame) {
        const double x = 0.5 * (level.columns() - 1) * level.pitch_x, y = 0.5 * (level.rows() - 1) * level.pitch_y;
        reach_ = std::abs(x * std::cos(frame.angle)) + std::abs(y * std::sin(frame.angle));
        width_ = 2 * reach_ / bins;
        for (int row = 0; row < level.rows(); ++row)
            for (int column = 0; column < level.columns(); ++column)
                if (const double z = level.height(column, row); std::isfinite(z)) {
                    const double u = frame.u(level.x(column), level.y(row));
                    const auto bin = static_cast<std::size_t>(std::clamp((u + reach_) / width_, 0.0, bins - 1.0));
                    count_[bin] += 1;
                    sum_[bin] += z;
                }
        level_out();
    }

    // The edges of largest gain. With one edge, the second is the end of the profile.
    Edges best(bool two) const {
        const std::size_t bins = count_.size(), margin = bins / 20;
        Edges best{.frame = frame_};
        for (std::size_t from = margin; from + margin < bins; ++from)
            for (std::size_t to = two ? from + margin : bins; two ? to + margin < bins : to == bins; ++to) {
                const double inside = counts_[to] - counts_[from], moment = moments_[to] - moments_[from];
                // The sum of squares of delta (1 inside, 0 outside) after mean and slope are removed.
                const double rest = inside - inside * inside / counts_[bins] - moment * moment / square_;
                const double product = products_[to] - products_[from];
                if (const double gain = product * product / rest; rest > 1e-6 * counts_[bins] && gain > best.gain)
                    best = {frame_, static_cast<double>(from) * width_ - reach_,
                            static_cast<double>(to) * width_ - reach_, gain, product / rest};
            }
        return best;
    }

  private:
    // Computes cumulative sums over the bins: of the count, of its first moment about the centre, and of the heights
    // after a line is removed.
    void level_out() {
        double total = 0, first = 0, sum = 0;
        for (std::size_t k = 0; k < count_.size(); ++k) {
            total += count_[k];
            first += count_[k] * static_cast<double>(k);
            sum += sum_[k];
        }
        double slope = 0;
        for (std::size_t k = 0; k < count_.size(); ++k) {
            const double u = static_cast<double>(k) - first / total;
            square_ += count_[k] * u * u;
            slope += sum_[k] * u;
        }
        counts_ = moments_ = products_ = {0.0};
        for (std::size_t k = 0; k < count_.size(); ++k) {
            const double u = static_cast<double>(k) - first / total;
            counts_.push_back(counts_.back() + count_[k]);
            moments_.push_back(moments_.back() + count_[k] * u);
            products_.push_back(products_.back() + sum_[k] - count_[k] * (sum / total + slope / square_ * u));
        }
    }

    std::vector<double> count_, sum_, counts_, moments_, products_;
    Frame frame_;
    double reach_ = 0, width_ = 0, square_ = 0;
};

Edges found_edges(const HeightMap& map, bool two) {
    const HeightMap level = surface::remove_plane(map, surface::least_squares_plane(map));
    const Frame middle{.x = map.x0 + 0.5 * (map.columns() - 1) * map.pitch_x,
                       .y = map.y0 + 0.5 * (map.rows() - 1) * map.pitch_y};
    Edges best{.frame = middle};
    const auto search = [&](double from, double to, double step, int bins) {
        for (double angle = from; angle <= to + 1e-9; angle += step) {
            Frame frame = middle;
            frame.angle = angle * radians_per_degree;
            if (const Edges edges = MeanProfile(level, frame, bins).best(two); edges.gain > best.gain)
                best = edges;
        }
    };
    search(-90, 85, 5, 100);
    const double near = best.frame.angle / radians_per_degree;
    best.gain = 0; // the finer bins start anew
    search(near - 5, near + 5, 0.5, 300);
    return best;
}

Frame moved(Frame frame, double u) {
    frame.x += u * std::cos(frame.angle);
    frame.y += u * std::sin(frame.angle);
    return frame;
}

std::vector<double> sorted_heights(const HeightMap& map) {
    std::vector<double> heights;
    std::ranges::copy_if(map.height.values, std::back_inserter(heights), [](double z) { return std::isfinite(z); });
    std::ranges::sort(heights);
    return heights;
}

double frequency_size(const std::array<double, 2>& frequency) {
    return std::hypot(frequency[0], frequency[1]);
}

// The width of the lines, from the share of points above the middle level.
double line_width_of(const HeightMap& map, double period) {
    const auto heights = sorted_heights(surface::remove_plane(map, surface::least_squares_plane(map)));
    const auto at = [&](double share) {
        return heights[static_cast<std::size_t>(share * static_cast<double>(heights.size() - 1))];
    };
    const double middle = 0.5 * (at(0.05) + at(0.95));
    const auto above = heights.end() - std::ranges::upper_bound(heights, middle);
    return period * static_cast<double>(above) / static_cast<double>(heights.size());
}

std::optional<Feature> found(const HeightMap& map, Sought sought) {
    if (sought == Sought::step) {
        const auto step = found_step(map);
        return step ? std::optional<Feature>(*step) : std::nullopt;
    }
    if (sought == Sought::groove) {
        const auto groove = found_groove(map);
        return groove ? std::optional<Feature>(*groove) : std::nullopt;
    }
    if (sought == Sought::flat)
        return Flat{};
    const auto first = strongest_frequency(map);
    if (!first)
        return std::nullopt;
    const Frame frame{.x = map.x0, .y = map.y0, .angle = std::atan2((*first)[1], (*first)[0])};
    const double period = 1 / frequency_size(*first);
    if (sought == Sought::sinusoid)
        return Sinusoid{.frame = frame, .amplitude = 0, .period = period};
    if (sought == Sought::grating)
        return Grating{.frame = frame, .period = period, .depth = 0, .line_width = line_width_of(map, period)};
    const auto second = strongest_frequency(map, first);
    if (!second)
        return std::nullopt;
    const double angle = std::atan2((*second)[1], (*second)[0]) - frame.angle;
    return CrossGrating{.frame = frame, .pitch_u = period, .pitch_v = 1 / frequency_size(*second), .angle = angle};
}

} // namespace

std::optional<Step> found_step(const HeightMap& map) {
    const Edges edges = found_edges(map, false);
    if (!(edges.gain > 0))
        return std::nullopt;
    return Step{.frame = moved(edges.frame, edges.first), .height = edges.height};
}

std::optional<Groove> found_groove(const HeightMap& map) {
    const Edges edges = found_edges(map, true);
    if (!(edges.gain > 0))
        return std::nullopt;
    Groove groove{.frame = moved(edges.frame, 0.5 * (edges.first + edges.second)),
                  .width = edges.second - edges.first,
                  .depth = -edges.height};
    if (const auto depth = groove_depth(map, groove))
        if (const auto width = groove_width(map, groove, *depth))
            groove.width = width->mean;
    return groove;
}

std::vector<Dimension> evaluate_found(const HeightMap& map, Sought sought) {
    constexpr double least_radius_in_errors = 5;
    std::vector<Dimension> dimensions;
    if (sought == Sought::sphere) {
        if (const auto sphere = found_sphere(map))
            dimensions = evaluate(map, *sphere);
        // The heights do not determine so small a radius, even if the fit succeeds.
        if (!dimensions.empty() &&
            !(dimensions.front().value >= least_radius_in_errors * dimensions.front().standard_error))
            dimensions.clear();
    } else if (const auto feature = found(map, sought)) {
        dimensions = evaluate(map, *feature);
    }
    for (auto& one : dimensions)
        one.nominal = surface::undefined;
    return dimensions;
}

} // namespace vkfv::dimensions
