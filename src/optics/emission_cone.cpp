#include "optics/emission_cone.hpp"

#include "core/parallel_list.hpp"
#include "core/units.hpp"
#include "optics/apertures.hpp"
#include "optics/bundle.hpp"
#include "optics/farthest.hpp"
#include "optics/train.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <vector>

namespace vkfv::optics {

namespace {

using physics::f64::PATH_ALIVE;
using physics::f64::Ray;
using physics::f64::Surface;

// The cone may be this much wider than the largest angle found to pass. A closer bound takes longer to prove and saves
// at most 4 % of the rays.
constexpr double margin = 1.02;

EmissionBox all_rays(bool symmetric, const DiscSource& source) {
    EmissionBox whole{};
    whole[from_axis] = {0, source.radius};
    whole[polar_angle] = {0, 0.5 * pi};
    // About the axis all turns are the same, and so are directions on either side of the start's meridian.
    whole[azimuth] = symmetric ? Range{0, pi} : Range{-pi, pi};
    whole[turn] = symmetric ? Range{} : Range{-pi, pi};
    whole[spectral] = source.monochromatic ? Range{} : Range{-1, 1};
    return whole;
}

// Sine of the largest angle among a few sampled rays of a box that pass; 0 if none does. The ray with the largest angle
// often starts at the source's rim, towards it or away from it.
double sampled_sine(std::span<const Surface> train, double source_distance, const EmissionBox& box) {
    std::array<double, Affine::coordinates> at{};
    for (const double polar_place : {1.0, 0.0, -1.0}) {
        at[polar_angle] = polar_place;
        for (const auto& [start, direction] : {std::pair{0.0, 0.0}, std::pair{1.0, 1.0}, std::pair{1.0, -1.0}}) {
            at[from_axis] = start;
            at[azimuth] = direction;
            auto [ray, x] = ray_in(box, at);
            ray.position.z -= source_distance;
            const double sine = glm::length(glm::dvec2(ray.direction));
            if (ray.direction.z > 0 && trace_through(train, ray, 1, x).status == PATH_ALIVE) {
                return sine;
            }
        }
    }
    return 0;
}

} // namespace

// From each point of the source, searches the rim around the direction that aims at the centre of the field stop.
double largest_sampled_sine(std::span<const Surface> train, bool symmetric, const DiscSource& source,
                            const RayTransfer& towards_stop) {
    const auto largest_from = [&](glm::dvec2 position) {
        constexpr int azimuths = 26;
        const double slope = -towards_stop.a / towards_stop.b;
        const glm::dvec2 centre = slope * position / std::sqrt(1 + slope * slope * glm::dot(position, position));
        double largest = 0;
        // Mirrored azimuths are the same for a symmetric train and a point of the x axis.
        for (int i = 0; i < (symmetric ? azimuths / 2 : azimuths); ++i) {
            const double angle = symmetric ? pi * i / (azimuths / 2 - 1) : 2 * pi * i / azimuths;
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
            largest = radius ? std::max(largest, glm::length(cosines(*radius))) : largest;
        }
        return largest;
    };
    double largest = 0;
    for (const glm::dvec2& direction : search_directions(symmetric)) {
        // The angle grows towards the rim of what the pupil sees of the source; beyond it no light passes. Two finer
        // rounds around the best point so far find that rim to 1/50 of the source.
        constexpr int points = 6;
        double low = 0;
        double high = source.radius;
        double best = 0;
        for (int round = 0; round < 3; ++round) {
            const double step = (high - low) / points;
            double largest_here = 0;
            const auto sines =
                parallel_list(points + 1, [&](int i) { return largest_from(direction * (low + i * step)); });
            for (int i = 0; i <= points; ++i) {
                if (const double sine = sines[static_cast<std::size_t>(i)]; sine > largest_here) {
                    largest_here = sine;
                    best = low + i * step;
                }
            }
            largest = std::max(largest, largest_here);
            low = std::max(0.0, best - step);
            high = std::min(source.radius, best + step);
        }
    }
    return largest;
}

// Branch and bound: the box with the largest angle is halved until either bounds prove that none of its rays passes, or
// its largest angle is hardly larger than that of a ray known to pass. However the search ends, the largest angle of
// all remaining boxes bounds the light.
double emission_sine(std::span<const Surface> train, bool symmetric, const DiscSource& source, double known_sine) {
    constexpr int most_boxes = 10000; // 0.1 s; a microscope's illuminator takes 2000
    constexpr double thin = 1e-3;     // of the angle: no use in halving what is still left then
    const BundleTracer tracer(train, source.distance);
    double sufficient = margin * known_sine;
    const auto is_narrower = [](const EmissionBox& a, const EmissionBox& b) {
        return a[polar_angle].high < b[polar_angle].high;
    };
    std::priority_queue<EmissionBox, std::vector<EmissionBox>, decltype(is_narrower)> left(is_narrower);
    left.push(all_rays(symmetric, source));
    const auto largest_left = [&] { return left.empty() ? 0 : std::sin(left.top()[polar_angle].high); };
    for (int boxes = 0; boxes < most_boxes && largest_left() > sufficient; ++boxes) {
        EmissionBox box = left.top();
        Range& angle = box[polar_angle];
        const bool is_thin = angle.low > (1 - thin) * angle.high && std::sin(angle.low) > sufficient;
        // Rays inside the known cone need not be excluded.
        angle.low = std::max(angle.low, std::asin(std::min(1.0, sufficient)));
        const auto cut = tracer.may_pass(box);
        if (cut && is_thin) {
            break;
        }
        left.pop();
        if (cut) {
            sufficient = std::max(sufficient, margin * sampled_sine(train, source.distance, box));
            EmissionBox lower = box;
            EmissionBox upper = box;
            lower[*cut].high = upper[*cut].low = box[*cut].middle();
            left.push(lower);
            left.push(upper);
        }
    }
    return std::min(1.0, std::max(sufficient, largest_left()));
}

} // namespace vkfv::optics
