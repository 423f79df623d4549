#include "optics/aim/aim.hpp"

#include "core/mathematics/units.hpp"
#include "core/threads/parallel_list.hpp"
#include "optics/aim/apertures.hpp"
#include "optics/aim/farthest.hpp"
#include "optics/train/bundle.hpp"
#include "optics/train/train.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

namespace vkfv::optics {

namespace {

using physics::f64::PATH_ALIVE;
using physics::f64::Ray;
using physics::f64::Surface;

// The proved disc may exceed the known one by this factor. A closer bound takes longer to prove and saves at most 4 %
// of the rays.
constexpr double margin = 1.02;

EmissionBox all_rays(bool symmetric, const DiscSource& source, const EmissionMiddle& middle) {
    EmissionBox whole{};
    whole[from_axis] = {0, source.radius};
    whole[from_middle] = {0, middle.reach + std::abs(middle.shift) * source.radius};
    // A symmetric train treats all rotations about the axis alike, and so directions on either side of the start's
    // meridian.
    whole[azimuth] = symmetric ? Range{0, pi} : Range{-pi, pi};
    whole[turn] = symmetric ? Range{} : Range{-pi, pi};
    whole[spectral] = source.monochromatic ? Range{} : Range{-1, 1};
    return whole;
}

// The distance from the middle of the farthest ray that passes among a few sampled in a box; 0 if none does. The
// farthest ray often starts at the source's rim, towards or away from the rim.
double sampled_distance(std::span<const Surface> train, double source_distance, const EmissionMiddle& middle,
                        const EmissionBox& box) {
    std::array<double, Affine::coordinates> at{};
    for (const double distance : {1.0, 0.0, -1.0}) {
        at[from_middle] = distance;
        for (const auto& [start, direction] : {std::pair{0.0, 0.0}, std::pair{1.0, 1.0}, std::pair{1.0, -1.0}}) {
            at[from_axis] = start;
            at[azimuth] = direction;
            auto emitted = ray_in(box, middle, at);
            if (!emitted) {
                continue;
            }
            emitted->ray.position.z -= source_distance;
            if (trace_through(train, emitted->ray, 1, emitted->spectral).status == PATH_ALIVE) {
                return box[from_middle].middle() + distance * box[from_middle].radius();
            }
        }
    }
    return 0;
}

bool is_within_hemisphere(const Aim& aim, double source_radius) {
    return std::abs(aim.shift) * source_radius + aim.sine <= 1;
}

// The smallest disc within the hemisphere that contains the rim. The size of a disc is a convex function of its shift,
// as the largest of many distances, so ternary search finds its minimum.
Aim smallest_aim(std::span<const RimRay> rim, double source_radius) {
    double low = -1 / source_radius; // for steeper shifts the middle leaves the hemisphere
    double high = 1 / source_radius;
    constexpr int rounds = 40;
    for (int round = 0; round < rounds; ++round) {
        const double a = low + (high - low) / 3;
        const double b = high - (high - low) / 3;
        if (aim_at(rim, a).sine < aim_at(rim, b).sine) {
            high = b;
        } else {
            low = a;
        }
    }
    double shift = 0.5 * (low + high);
    const auto fits = [&](double candidate) {
        return is_within_hemisphere({.shift = candidate, .sine = margin * aim_at(rim, candidate).sine}, source_radius);
    };
    if (!fits(shift)) { // take the nearest shift within the hemisphere, if any
        double inside = 0;
        for (int round = 0; round < rounds; ++round) {
            const double middle = 0.5 * (inside + shift);
            (fits(middle) ? inside : shift) = middle;
        }
        shift = inside;
    }
    return aim_at(rim, shift);
}

} // namespace

// The search goes from points of the source, around the direction that aims at the centre of the field stop.
std::vector<RimRay> sampled_rim(std::span<const Surface> train, bool symmetric, const DiscSource& source,
                                const RayTransfer& towards_stop) {
    const auto rim_from = [&](glm::dvec2 position) {
        const int azimuths = symmetric ? 13 : 26; // over half a turn or a whole one
        const double slope = -towards_stop.a / towards_stop.b;
        const glm::dvec2 centre = slope * position / std::sqrt(1 + slope * slope * glm::dot(position, position));
        std::vector<RimRay> rim;
        // For a symmetric train and a point on the x axis, mirrored azimuths are equivalent.
        for (int i = 0; i < azimuths; ++i) {
            const double angle = symmetric ? pi * i / (azimuths - 1) : 2 * pi * i / azimuths;
            const auto cosines = [&](double radius) {
                return centre + radius * glm::dvec2(std::cos(angle), std::sin(angle));
            };
            const auto radius = farthest(1 + glm::length(centre), [&](double candidate) {
                const glm::dvec2 direction = cosines(candidate);
                const double axial_squared = 1 - glm::dot(direction, direction);
                if (axial_squared <= 0) {
                    return std::numeric_limits<double>::infinity();
                }
                Ray ray{};
                ray.position = glm::dvec3(position, -source.distance);
                ray.direction = glm::dvec3(direction, std::sqrt(axial_squared));
                return excess_of(train, ray);
            });
            if (radius) {
                rim.push_back({position, cosines(*radius)});
            }
        }
        return rim;
    };
    std::vector<RimRay> all;
    for (const glm::dvec2& direction : search_directions(symmetric)) {
        // The angle grows towards the rim of the region of the source that the pupil sees; no light passes from beyond.
        // Two finer rounds around the best point so far find that rim to 1/50 of the source.
        constexpr int points = 6;
        double low = 0;
        double high = source.radius;
        double best = 0;
        for (int round = 0; round < 3; ++round) {
            const double step = (high - low) / points;
            double largest_here = 0;
            const auto rims = parallel_list(points + 1, [&](int i) { return rim_from(direction * (low + i * step)); });
            for (int i = 0; i <= points; ++i) {
                const std::vector<RimRay>& rim = rims[static_cast<std::size_t>(i)];
                all.insert(all.end(), rim.begin(), rim.end());
                if (const double sine = aim_at(rim, 0).sine; sine > largest_here) {
                    largest_here = sine;
                    best = low + i * step;
                }
            }
            low = std::max(0.0, best - step);
            high = std::min(source.radius, best + step);
        }
    }
    return all;
}

Aim aim_at(std::span<const RimRay> rim, double shift) {
    Aim result{.shift = shift, .sine = 0};
    for (const RimRay& ray : rim) {
        result.sine = std::max(result.sine, glm::length(ray.cosines - shift * ray.position));
    }
    return result;
}

// Branch and bound: the box with the rays farthest from their middle is halved until bounds prove that none of its rays
// passes, or until its rays are hardly farther than a ray known to pass. However the search ends, the farthest of all
// remaining boxes bounds the light.
Aim proved_aim(std::span<const Surface> train, bool symmetric, const DiscSource& source, const Aim& known,
               double reach) {
    constexpr int most_boxes = 10000; // takes 0.1 s; a microscope's illuminator takes 2000 boxes
    constexpr double thin = 1e-3;     // relative width below which halving a box no longer helps
    const EmissionMiddle middle{.shift = known.shift, .reach = reach};
    const BundleTracer tracer(train, source.distance, middle);
    double sufficient = margin * known.sine;
    const auto is_nearer = [](const EmissionBox& a, const EmissionBox& b) {
        return a[from_middle].high < b[from_middle].high;
    };
    std::priority_queue<EmissionBox, std::vector<EmissionBox>, decltype(is_nearer)> left(is_nearer);
    left.push(all_rays(symmetric, source, middle));
    const auto farthest_left = [&] { return left.empty() ? 0 : left.top()[from_middle].high; };
    for (int boxes = 0; boxes < most_boxes && farthest_left() > sufficient; ++boxes) {
        EmissionBox box = left.top();
        Range& distance = box[from_middle];
        const bool is_thin = distance.low > (1 - thin) * distance.high && distance.low > sufficient;
        // Only rays outside the known disc must be excluded.
        distance.low = std::max(distance.low, sufficient);
        const auto cut = tracer.may_pass(box);
        if (cut && is_thin) {
            break;
        }
        left.pop();
        if (cut) {
            sufficient = std::max(sufficient, margin * sampled_distance(train, source.distance, middle, box));
            EmissionBox lower = box;
            EmissionBox upper = box;
            lower[*cut].high = upper[*cut].low = box[*cut].middle();
            left.push(lower);
            left.push(upper);
        }
    }
    const double sine = std::max(sufficient, farthest_left());
    return {.shift = known.shift, .sine = known.shift == 0 ? std::min(1.0, sine) : sine};
}

Aim best_aim(std::span<const Surface> train, bool symmetric, const DiscSource& source, std::span<const RimRay> rim) {
    const Aim cone = proved_aim(train, symmetric, source, aim_at(rim, 0));
    if (rim.empty() || !(source.radius > 0)) {
        return cone;
    }
    const Aim sampled = smallest_aim(rim, source.radius);
    if (!(margin * sampled.sine < cone.sine)) {
        return cone;
    }
    const Aim shifted = proved_aim(train, symmetric, source, sampled, cone.sine);
    return shifted.sine < cone.sine && is_within_hemisphere(shifted, source.radius) ? shifted : cone;
}

} // namespace vkfv::optics
