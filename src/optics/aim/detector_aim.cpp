#include "optics/aim/detector_aim.hpp"

#include "core/mathematics/units.hpp"
#include "core/threads/parallel_list.hpp"
#include "optics/aim/farthest.hpp"
#include "optics/train/train.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace vkfv::optics {

namespace {

using physics::f64::PATH_ALIVE;
using physics::f64::Ray;
using physics::f64::Surface;

// The largest share of the disc's rays that the rectangle may need and still be worth using.
constexpr double worthwhile = 0.98;
// The factor on errors found by sampling. Samples stand on the rims themselves, but 15 degrees of azimuth apart: a term
// of three times the azimuth may be 8 % larger between two of them (1 / cos 22.5 degrees).
constexpr double sampling_margin = 1.25;
// The relative allowance for rounding: far more than the 1e-6 of a device's float.
constexpr double rounding = 1e-3;

// Light from a disc through a rotationally symmetric train to a plane; lengths in mm.
struct SampledLight {
    std::span<const Surface> train;
    DiscSource source;
    double shift = 0;    // 1/mm, direction middle per position (Aim)
    double farthest = 1; // largest distance of transverse cosines from that middle
    double plane = 0;    // mm behind the train's last vertex
};

struct PassedRay {
    glm::dvec2 place{0};
    glm::dvec2 direction{0}; // transverse direction cosines relative to their middle
    glm::dvec2 end{0};
};

// Passing rays from a point on the x axis whose directions lie at an angle (rad) to it, from the middle to the rim of
// the passing light.
std::vector<PassedRay> sampled_from(const SampledLight& way, double distance_from_axis, double angle) {
    constexpr int distances = 12;
    const std::vector<double> wavelengths =
        way.source.monochromatic ? std::vector{0.0} : std::vector{-1.0, -0.5, 0.0, 0.5, 1.0};
    std::vector<PassedRay> passed;
    const glm::dvec2 place = {distance_from_axis, 0};
    const glm::dvec2 towards = {std::cos(angle), std::sin(angle)};
    const auto ray_at = [&](double distance) {
        const glm::dvec2 cosines = way.shift * place + distance * towards;
        Ray ray{};
        ray.position = glm::dvec3(place, -way.source.distance);
        ray.direction = glm::dvec3(cosines, std::sqrt(std::max(0.0, 1 - glm::dot(cosines, cosines))));
        return ray;
    };
    for (const double spectral : wavelengths) {
        const auto add = [&](double distance) {
            const auto light = trace_through(way.train, ray_at(distance), 1, spectral);
            if (light.status == PATH_ALIVE) {
                const Ray ended = physics::f64::fly_to_plane(light.ray, way.plane, light.index);
                passed.push_back({place, distance * towards, glm::dvec2(ended.position)});
            }
        };
        for (int step = 0; step <= distances; ++step) {
            add(way.farthest * step / distances);
        }
        if (const auto rim = farthest(way.farthest, [&](double distance) {
                const Ray ray = ray_at(distance);
                return ray.direction.z > 0 ? excess_of(way.train, ray, spectral)
                                           : std::numeric_limits<double>::infinity();
            })) {
            add(*rim);
        }
    }
    return passed;
}

// Passing rays from the axis to the outermost place whose light passes, which may lie far within the source, at all
// azimuths of direction. By symmetry it is enough to start on the x axis.
std::vector<PassedRay> sampled(const SampledLight& way) {
    constexpr int starts = 13, azimuths = 13, steps = 64, halvings = 6;
    const auto angle = [](int k) { return pi * k / (azimuths - 1); };
    const auto passes_from = [&](double distance_from_axis) {
        for (int k = 0; k < azimuths; ++k) {
            if (!sampled_from(way, distance_from_axis, angle(k)).empty()) {
                return true;
            }
        }
        return false;
    };
    const auto passes =
        parallel_list(steps + 1, [&](int k) -> int { return passes_from(way.source.radius * k / steps); });
    const auto last = std::find(passes.rbegin(), passes.rend(), 1);
    double inside = way.source.radius * std::max(0.0, static_cast<double>(passes.rend() - last - 1)) / steps;
    double outside = std::min(way.source.radius, inside + way.source.radius / steps);
    for (int k = 0; k < halvings && outside > inside; ++k) {
        const double middle = std::midpoint(inside, outside);
        (passes_from(middle) ? inside : outside) = middle;
    }
    std::vector<PassedRay> all;
    for (const auto& part : parallel_list(starts * azimuths, [&](int k) {
             return sampled_from(way, inside * (k % starts) / (starts - 1), angle(k / starts));
         })) {
        all.insert(all.end(), part.begin(), part.end());
    }
    return all;
}

// A linear relation between two vectors of each ray: the second is `factor` times the first, with the largest deviation
// `error`.
struct Proportion {
    double factor = 0;
    double error = 0;
};
using Vectors = std::vector<std::pair<glm::dvec2, glm::dvec2>>;

// The factor of the least error within 10 % of the least-squares factor; the error is a convex function of it. The
// error is infinite without rays.
Proportion proportion_of(const Vectors& vectors) {
    if (vectors.empty()) {
        return {.factor = 1, .error = std::numeric_limits<double>::infinity()};
    }
    const auto error = [&](double factor) {
        double greatest = 0;
        for (const auto& [from, to] : vectors) {
            greatest = std::max(greatest, glm::length(to - factor * from));
        }
        return greatest;
    };
    double products = 0;
    double squares = 0;
    for (const auto& [from, to] : vectors) {
        products += glm::dot(from, to);
        squares += glm::dot(from, from);
    }
    double low = 0.9 * products / squares;
    double high = 1.1 * products / squares;
    constexpr int rounds = 40; // each round keeps two thirds of the interval
    for (int round = 0; round < rounds; ++round) {
        const double a = low + (high - low) / 3;
        const double b = high - (high - low) / 3;
        if (error(a) < error(b)) {
            high = b;
        } else {
            low = a;
        }
    }
    const double factor = std::midpoint(low, high);
    return {.factor = factor, .error = error(factor)};
}

double slope_of(double sine) {
    return sine / std::sqrt(1 - sine * sine);
}

} // namespace

// A ray is a straight line above and below focus, so its deviation is largest at one end of the range of heights.
std::optional<glm::dvec2> aim_at_detector(const SingleScatter& light, const Aim& disc) {
    const std::array ends = {-light.greatest_defocus, light.greatest_defocus};
    Vectors lit; // places where light arrives, with directions
    for (const double height : ends) {
        for (const PassedRay& ray : sampled({.train = light.illumination,
                                    .source = light.source,
                                    .shift = disc.shift,
                                    .farthest = disc.sine,
                                    .plane = light.front_vertex_height - height})) {
            lit.emplace_back(ray.end, ray.direction);
        }
    }
    const Proportion per_length = proportion_of(lit);
    const double direction_error = sampling_margin * per_length.error;
    if (!(direction_error < disc.sine)) { // the source is imaged onto the specimen, or no light passes
        return std::nullopt;
    }
    const double lit_radius = (disc.sine + direction_error) / std::abs(per_length.factor);

    SampledLight imaging = {.train = light.imaging,
                            .source = {.radius = lit_radius,
                                       .distance = light.front_vertex_height,
                                       .monochromatic = light.source.monochromatic},
                            .plane = light.detector_distance};
    double sine = 0;
    for (const PassedRay& ray : sampled(imaging)) {
        sine = std::max(sine, glm::length(ray.direction));
    }
    // Light seen at one end of the range of heights crosses the plane at the other end further out.
    constexpr double steepest = 0.99;
    imaging.source.radius += 2 * light.greatest_defocus * slope_of(std::min(sampling_margin * sine, steepest));
    Vectors seen; // places where light starts, with its landing places
    for (const double height : ends) {
        imaging.source.distance = light.front_vertex_height - height;
        for (const PassedRay& ray : sampled(imaging)) {
            seen.emplace_back(ray.place, ray.end);
        }
    }
    const Proportion magnification = proportion_of(seen);
    const glm::dvec2 field =
        (light.detector_half_sides + sampling_margin * magnification.error) / std::abs(magnification.factor);
    const glm::dvec2 wanted = (1 + rounding) * (std::abs(per_length.factor) * field + direction_error);
    // Rounding up to steps makes machines whose libraries round differently agree, so that they can share a stack.
    constexpr double steps = 1 << 20;
    const glm::dvec2 sides = glm::min(glm::ceil(wanted * steps) / steps, glm::dvec2(disc.sine));
    const double share = 4 * sides.x * sides.y / (pi * disc.sine * disc.sine);
    return share < worthwhile ? std::optional(sides) : std::nullopt;
}

} // namespace vkfv::optics
