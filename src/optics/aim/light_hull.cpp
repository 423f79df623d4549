#include "optics/aim/light_hull.hpp"

#include "core/mathematics/units.hpp"
#include "core/threads/parallel_list.hpp"
#include "optics/aim/farthest.hpp"
#include "optics/train/train.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <random>
#include <vector>

namespace vkfv::optics {

namespace {

using physics::f64::PATH_ALIVE;
using physics::f64::Ray;

// The coordinates of a ray of the light: where it starts in the disc, its direction, its wavelength and the disc's
// place.
enum HullCoordinate : std::size_t {
    place_radius,      // share of the disc's radius
    place_azimuth,     // rad
    direction_azimuth, // rad, relative to place_azimuth
    cone_share,        // share of the distance from the cone's middle to its rim
    wavelength,        // Light::spectral, -1 to 1 over the spectrum
    disc_distance,     // mm
    hull_coordinates,
};
using HullPlace = std::array<double, hull_coordinates>;

// The range of a coordinate, and the number of grid points in it.
struct HullAxis {
    Range range;
    int points = 1;
    bool turns = false; // true for a whole turn, whose ends coincide

    double at(int k) const {
        return points > 1 ? range.low + (range.high - range.low) * k / (turns ? points : points - 1) : range.low;
    }
    double spacing() const { return points > 1 ? (range.high - range.low) / (turns ? points : points - 1) : 0; }
};
using HullAxes = std::array<HullAxis, hull_coordinates>;

HullAxes axes_of(const DiscLight& light, ConePart part) {
    const auto points = [](const Range& range, int several) { return range.high > range.low ? several : 1; };
    HullAxes axes;
    axes[place_radius] = {{0, 1}, light.radius > 0 ? (light.symmetric ? 7 : 5) : 1};
    axes[wavelength] = {light.spectral, points(light.spectral, light.symmetric ? 5 : 3)};
    axes[disc_distance] = {light.distance, points(light.distance, 2)};
    axes[cone_share] = part == ConePart::whole ? HullAxis{{0, 1}, 5} : HullAxis{{1, 1}, 1};
    if (light.symmetric) { // symmetry fixes the place's azimuth and halves that of the direction
        axes[place_azimuth] = {{0, 0}, 1};
        axes[direction_azimuth] = {{0, pi}, 9};
    } else {
        axes[place_azimuth] = {{0, 2 * pi}, 8, true};
        axes[direction_azimuth] = {{0, 2 * pi}, 12, true};
    }
    return axes;
}

// The cone of light that leaves a place of the disc at one wavelength.
class Cone {
  public:
    Cone(const DiscLight& light, const HullPlace& at)
        : light_(light), start_(at[place_radius] * light.radius *
                                glm::dvec2(std::cos(at[place_azimuth]), std::sin(at[place_azimuth]))),
          distance_(at[disc_distance]), spectral_(at[wavelength]) {}

    // The ray in the direction `angle` (rad) from a passing middle ray, at a share of the distance to the last ray that
    // passes. None if no ray of the cone is found.
    std::optional<PassingRay> ray_at(double angle, double share) const {
        const auto middle = middle_of_light();
        if (!middle) {
            return std::nullopt;
        }
        const glm::dvec2 along = {std::cos(angle), std::sin(angle)};
        const auto excess = [&](double radius) { return excess_at(*middle + radius * along); };
        double limit = 2 * light_.reach;
        constexpr int doublings = 12;
        for (int k = 0; k < doublings && excess(limit) <= 0; ++k) {
            limit *= 2;
        }
        // The factor keeps the ray within the rim, which rounding may put on either side of an edge.
        const double rim = (1 - 1e-9) * farthest(limit, excess, 30).value_or(0);
        return passed(*middle + share * rim * along);
    }

  private:
    Ray ray_of(glm::dvec2 slope) const {
        Ray ray{};
        ray.position = glm::dvec3(start_, -distance_);
        ray.direction = glm::dvec3(slope, 1) / std::sqrt(1 + glm::dot(slope, slope));
        return ray;
    }
    // At most 0 if the ray of this slope passes the train.
    double excess_at(glm::dvec2 slope) const { return excess_of(light_.train, ray_of(slope), spectral_); }

    // The slope at which light is expected or, if none passes there, the mean of passing slopes around it.
    std::optional<glm::dvec2> middle_of_light() const {
        const glm::dvec2 expected = light_.middle + light_.towards * start_;
        if (excess_at(expected) <= 0) {
            return expected;
        }
        constexpr int circles = 8, azimuths = 12;
        glm::dvec2 sum(0);
        int count = 0;
        std::optional<glm::dvec2> one;
        for (int circle = 1; circle <= circles; ++circle) {
            for (int k = 0; k < azimuths; ++k) {
                const double angle = 2 * pi * k / azimuths;
                const glm::dvec2 slope =
                    expected + 2 * light_.reach * circle / circles * glm::dvec2(std::cos(angle), std::sin(angle));
                if (excess_at(slope) <= 0) {
                    sum += slope;
                    count += 1;
                    one = slope;
                }
            }
        }
        if (count > 0 && excess_at(sum / static_cast<double>(count)) <= 0) {
            return sum / static_cast<double>(count);
        }
        return one;
    }

    std::optional<PassingRay> passed(glm::dvec2 slope) const {
        const auto result = trace_through(light_.train, ray_of(slope), 1, spectral_);
        if (result.status != PATH_ALIVE) {
            return std::nullopt;
        }
        const Ray ended = physics::f64::fly_to_plane(result.ray, 0, result.index);
        return PassingRay{.start = start_,
                          .start_slope = slope,
                          .distance = distance_,
                          .end = glm::dvec2(ended.position),
                          .end_slope = glm::dvec2(ended.direction) / ended.direction.z};
    }

    const DiscLight& light_;
    glm::dvec2 start_;
    double distance_;
    double spectral_;
};

constexpr double nothing = -1; // stands for the measure of a ray that does not pass, below all others

struct HullPoint {
    HullPlace at{};
    double measure = nothing;
};

double measure_at(const DiscLight& light, const RayMeasure& measure, const HullPlace& at) {
    const auto ray = Cone(light, at).ray_at(at[place_azimuth] + at[direction_azimuth], at[cone_share]);
    return ray ? measure(*ray) : nothing;
}

// Climbs by steps in random directions, which grow after a step uphill and shrink after one downhill: where edges meet,
// the measure has ridges that steps along the coordinates do not follow.
double climbed(const HullAxes& axes, HullPoint from, const std::function<double(const HullPlace&)>& measure) {
    constexpr int most_steps = 400;
    constexpr double longer = 1.5, shorter = 0.96, shortest = 1e-4;
    std::mt19937_64 random(1); // fixed seed, for equal results on every machine
    double size = 0.5;         // in units of the grid's spacing
    for (int step = 0; step < most_steps && size > shortest; ++step) {
        HullPoint next = from;
        for (std::size_t which = 0; which < axes.size(); ++which) {
            const HullAxis& axis = axes[which];
            const double way = std::ldexp(static_cast<double>(random() >> 11), -52) - 1; // uniform in [-1, 1)
            next.at[which] += size * way * axis.spacing();
            if (!axis.turns) {
                next.at[which] = std::clamp(next.at[which], axis.range.low, axis.range.high);
            }
        }
        next.measure = measure(next.at);
        const bool higher = next.measure > from.measure;
        size = higher ? std::min(1.0, longer * size) : shorter * size;
        from = higher ? next : from;
    }
    return from.measure;
}

// Rounds up to the next of 256 steps an octave, after an allowance for what the search has left out and for the
// rounding of a device's float.
double rounded_up(double value) {
    constexpr double left = 1.003; // the allowance, as a factor
    int exponent = 0;
    const double mantissa = std::frexp(left * value, &exponent);
    return std::ldexp(std::ceil(mantissa * 512) / 512, exponent);
}

} // namespace

double greatest_of(const DiscLight& light, ConePart part, const RayMeasure& measure) {
    const HullAxes axes = axes_of(light, part);
    int points = 1;
    for (const HullAxis& axis : axes) {
        points *= axis.points;
    }
    const auto of = [&](const HullPlace& at) { return measure_at(light, measure, at); };
    const std::vector<HullPoint> grid = parallel_list(points, [&](int k) {
        HullPoint point;
        for (std::size_t which = 0; which < axes.size(); ++which) {
            point.at[which] = axes[which].at(k % axes[which].points);
            k /= axes[which].points;
        }
        point.measure = of(point.at);
        return point;
    });
    // The best grid point of each wavelength is the start of a climb of its own.
    const HullAxis& spectrum = axes[wavelength];
    const std::vector<double> tops = parallel_list(spectrum.points, [&](int k) {
        HullPoint highest;
        for (const HullPoint& point : grid) {
            if (point.at[wavelength] == spectrum.at(k) && point.measure > highest.measure) {
                highest = point;
            }
        }
        return highest.measure > nothing ? climbed(axes, highest, of) : nothing;
    });
    const double top = *std::ranges::max_element(tops);
    return top > 0 ? rounded_up(top) : 0;
}

} // namespace vkfv::optics
