// Flatness deviation z_FLT: ISO 25178-600, by averages over places of a flat.
#include "core/mathematics/units.hpp"
#include "measurement/calibration/standards.hpp"
#include "surface/filter.hpp"
#include "surface/height_parameters.hpp"

#include <boost/math/distributions/normal.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

namespace vkfv::measurement {

namespace {
namespace of_flatness { // files of a unity build share the unnamed namespace

std::vector<int> counts_of(const Conditions& conditions) {
    return conditions.small ? std::vector{4, 10} : std::vector{4, 10, 25};
}

// Prints of other seeds are other places of a flat.
std::vector<Trial> trials(const Conditions& conditions, std::vector<std::string>& /*remarks*/) {
    std::vector<Trial> list;
    for (int k = 0; k < counts_of(conditions).back(); ++k) {
        list.push_back({.name = fmt::format("place_{:02}", k),
                        .specimen = standard_of(conditions, "plane", "", 0) +
                                    printed(conditions, usual_contrast, static_cast<std::uint32_t>(k + 1)),
                        .overrides = repetition(conditions, k)});
    }
    return list;
}

surface::HeightMap mean_of(std::span<const surface::HeightMap* const> maps) {
    surface::HeightMap mean = *maps.front();
    for (std::size_t k = 0; k < mean.height.values.size(); ++k) {
        double sum = 0, count = 0;
        for (const surface::HeightMap* map : maps) {
            if (std::isfinite(map->height.values[k])) {
                sum += map->height.values[k];
                count += 1;
            }
        }
        mean.height.values[k] = sum / count; // NaN where no map has a height
    }
    return mean;
}

// Points farther from the median than five standard deviations, estimated by the median absolute deviation, are taken
// out.
void take_out_outliers(surface::HeightMap& map) {
    constexpr double deviations = 5, normal_factor = 1.4826;
    const double median = median_of(map.height.values);
    std::vector<double> distances = map.height.values;
    std::ranges::transform(distances, distances.begin(), [&](double h) { return std::abs(h - median); });
    const double limit = deviations * normal_factor * median_of(std::move(distances));
    for (double& height : map.height.values) {
        height = std::abs(height - median) > limit ? surface::undefined : height;
    }
}

surface::HeightMap levelled_and_filtered(const surface::HeightMap& map, double s_filter) {
    auto result = surface::gaussian_low_pass(surface::remove_plane(map, surface::least_squares_plane(map)), s_filter);
    take_out_outliers(result);
    return result;
}

double flatness_of(std::span<const surface::HeightMap* const> maps, double s_filter) {
    return surface::height_parameters(levelled_and_filtered(mean_of(maps), s_filter)).sz;
}

// The expected range of a smooth normal field of unit variance over a rectangle, by the expected Euler characteristic
// of the places above a level (R. J. Adler, "The Geometry of Random Fields", 1981; K. J. Worsley, Adv. Appl. Prob. 28,
// 13 (1996)): it is the probability that the maximum exceeds a high level. sides: mm. deviation: mm, of the Gaussian
// that white noise was filtered by, whose field has slopes of the variance 1 / (2 deviation^2).
double expected_range(glm::dvec2 sides, double deviation) {
    const boost::math::normal normal;
    const double slope = 1 / (std::sqrt(2.0) * deviation);
    constexpr double end = 9, step = 0.002;
    double most = 0, maximum = 0;
    for (double level = end; level > 0; level -= step) {
        const double gauss = std::exp(-0.5 * level * level);
        const double places = boost::math::cdf(boost::math::complement(normal, level)) +
                              (sides.x + sides.y) * slope * gauss / (2 * pi) +
                              sides.x * sides.y * slope * slope * level * gauss / std::pow(2 * pi, 1.5);
        most = std::max(most, places); // at low levels holes make the characteristic small
        maximum += step * (1 - std::exp(-most));
    }
    return 2 * maximum;
}

// Standard deviation over the places of the filtered heights, root mean square over the points, mm.
double scatter_of_places(std::span<const TrialResult> results, double s_filter) {
    std::vector<surface::HeightMap> maps;
    for (const auto& one : results) {
        maps.push_back(levelled_and_filtered(one.heights, s_filter));
    }
    double variance = 0, points = 0;
    for (std::size_t k = 0; k < maps.front().height.values.size(); ++k) {
        double sum = 0, square = 0, count = 0;
        for (const auto& map : maps) {
            if (const double height = map.height.values[k]; std::isfinite(height)) {
                sum += height;
                square += height * height;
                count += 1;
            }
        }
        if (count > 1) {
            variance += (square - sum * sum / count) / (count - 1);
            points += 1;
        }
    }
    return std::sqrt(variance / points);
}

// Standard error of the flatness deviation of all places, by the bootstrap over the places.
double uncertainty_of_flatness(std::span<const TrialResult> results, double s_filter) {
    constexpr int draws = 50;
    std::mt19937 random(1);
    double sum = 0, square = 0;
    for (int draw = 0; draw < draws; ++draw) {
        std::vector<const surface::HeightMap*> drawn;
        for (std::size_t k = 0; k < results.size(); ++k) {
            drawn.push_back(&results[random() % results.size()].heights);
        }
        const double sz = flatness_of(drawn, s_filter);
        sum += sz;
        square += sz * sz;
    }
    return std::sqrt(std::max(0.0, (square - sum * sum / draws) / (draws - 1)));
}

Findings evaluate(const Conditions& conditions, std::span<const TrialResult> results) {
    const double s_filter = conditions.s_filter();
    const double scatter = scatter_of_places(results, s_filter);
    // The standard deviation of the S-filter's Gaussian, alpha L / sqrt(2 pi) with alpha^2 = ln 2 / pi, and that of the
    // window.
    const double deviation =
        std::sqrt(std::log(2.0) / pi / (2 * pi) * s_filter * s_filter + conditions.window * conditions.window / 12);
    const glm::dvec2 sides(conditions.pixels.columns * conditions.pitch, conditions.pixels.rows * conditions.pitch);
    const double range = expected_range(sides, deviation);
    Findings findings;
    CertificateTable table{.caption = "Flatness deviation over the number of places",
                           .columns = {"places", "z_FLT / nm", "expected of the places' scatter alone / nm"},
                           .rows = {}};
    report::Curve found{.name = "z_FLT", .points = {}, .spreads = {}, .markers = true};
    report::Curve by_scatter{.name = "expected of scatter alone", .points = {}, .spreads = {}, .markers = true};
    constexpr double nm = 1e6;
    for (const int count : counts_of(conditions)) {
        std::vector<const surface::HeightMap*> maps;
        for (int k = 0; k < count; ++k) {
            maps.push_back(&results[static_cast<std::size_t>(k)].heights);
        }
        const double sz = flatness_of(maps, s_filter) * nm;
        const double alone = range * scatter / std::sqrt(count) * nm;
        table.rows.push_back({static_cast<double>(count), sz, alone});
        found.points.emplace_back(count, sz);
        by_scatter.points.emplace_back(count, alone);
    }
    const double u = uncertainty_of_flatness(results, s_filter) * nm;
    findings.figures.push_back(
        {.key = "z_FLT_nm",
         .title = fmt::format("z_FLT, mean of {} places, S-filter {:.3g} µm", results.size(), s_filter * um_per_mm),
         .unit = "nm",
         .value = table.rows.back()[1],
         .standard_uncertainty = u});
    findings.figures.push_back({.key = "z_FLT_by_scatter_nm",
                                .title = "of it, expected of scatter between places alone",
                                .unit = "nm",
                                .value = table.rows.back()[2]});
    findings.charts.push_back({.title = "Flatness deviation over the number of places",
                               .x_label = "places",
                               .y_label = "z_FLT / nm",
                               .curves = {found, by_scatter}});
    findings.tables.push_back(std::move(table));
    return findings;
}

} // namespace of_flatness
} // namespace

Characteristic flatness_deviation() {
    return {.name = "z_FLT",
            .title = "Flatness deviation",
            .standard = "A level flat with a printed texture (type AFL), measured at places that share no texture.",
            .procedure = "The mean of the measurements is levelled by its least-squares plane and S-filtered; points "
                         "beyond 5 x 1.4826 times the median absolute deviation are taken out; z_FLT is the Sz of the "
                         "rest. The scatter between places, of noise and texture, would alone give the expected "
                         "range of a normal field as smooth as the filter makes it. The standard uncertainty is that "
                         "of the bootstrap over the places.",
            .equation = R"(z_{FLT} = S_z\left(\frac{1}{n} \sum_{i = 1}^{n} z_i\right))",
            .trials = of_flatness::trials,
            .evaluate = of_flatness::evaluate};
}

} // namespace vkfv::measurement
