#include "optics/aim/apertures.hpp"

#include "core/mathematics/units.hpp"
#include "core/threads/parallel_list.hpp"
#include "optics/aim/farthest.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace vkfv::optics {

namespace {

using physics::f64::PATH_ALIVE;
using physics::f64::Ray;
using physics::f64::real3;
using physics::f64::Surface;

// Extremes between the finitely many sampled places exceed the sampled ones by less than this factor, as outlines of
// pupils are smooth except at corners where two edges meet.
constexpr double search_margin = 1.02;

// The ray in the frame in which light enters the train; none if the cosines are no direction.
std::optional<Ray> entering(const Imaging& imaging, glm::dvec2 position, double height, glm::dvec2 cosines) {
    const double axial_squared = 1 - glm::dot(cosines, cosines);
    if (axial_squared <= 0) {
        return std::nullopt;
    }
    Ray ray{};
    ray.position = real3(position, height - imaging.working_distance);
    ray.direction = real3(cosines, std::sqrt(axial_squared));
    return ray;
}

} // namespace

std::vector<glm::dvec2> search_directions(bool symmetric) {
    constexpr int all_round = 8;
    std::vector<glm::dvec2> directions = {{1, 0}};
    for (int i = 1; !symmetric && i < all_round; ++i) {
        const double angle = 2 * pi * i / all_round;
        directions.emplace_back(std::cos(angle), std::sin(angle));
    }
    return directions;
}

std::optional<Imaging::Landing> Imaging::trace(glm::dvec2 position, double height, glm::dvec2 cosines,
                                               std::uint32_t apertures, double spectral) const {
    const auto ray = entering(*this, position, height, cosines);
    if (!ray) {
        return std::nullopt;
    }
    const auto result = trace_through(train, *ray, apertures, spectral);
    if (result.status != PATH_ALIVE) {
        return std::nullopt;
    }
    const auto arrived = physics::f64::fly_to_plane(result.ray, detector_distance, result.index);
    return Landing{.position = {arrived.position.x, arrived.position.y},
                   .direction = arrived.direction,
                   .path_length = arrived.path_length};
}

double Imaging::excess(glm::dvec2 position, double height, glm::dvec2 cosines) const {
    const auto ray = entering(*this, position, height, cosines);
    return ray ? excess_of(train, *ray) : std::numeric_limits<double>::infinity();
}

glm::dvec2 Imaging::chief_cosines(glm::dvec2 position) const {
    const glm::dvec2 slope = -pupil_curvature * position;
    return slope / std::sqrt(1 + glm::dot(slope, slope));
}

glm::dvec2 Outline::cosines(std::size_t azimuth, double radius) const {
    const double angle = (static_cast<double>(azimuth) + 0.5) * step;
    return centre + radius * glm::dvec2(std::cos(angle), std::sin(angle));
}

double Outline::area() const {
    double sum = 0;
    for (const double radius : radii) {
        sum += 0.5 * radius * radius * step;
    }
    return sum;
}

Imaging at_wavelength(Imaging imaging, double spectral) {
    for (Surface& surface : imaging.train) {
        surface.index_before += physics::f64::disperse(surface.dispersion_before, spectral);
        surface.index_after += physics::f64::disperse(surface.dispersion_after, spectral);
        surface.dispersion_before = surface.dispersion_after = {};
    }
    imaging.detector_index = imaging.train.empty() ? 1 : imaging.train.back().index_after;
    return imaging;
}

Outline outline_at(const Imaging& imaging, glm::dvec2 position) {
    constexpr std::size_t azimuths = 48;
    Outline outline{
        .position = position, .centre = imaging.chief_cosines(position), .radii = {}, .step = 2 * pi / azimuths};
    // From a point on the x axis, the lower half of a symmetric cone is the mirror image of the upper half.
    const bool half = imaging.symmetric && position.y == 0;
    for (std::size_t i = 0; i < (half ? azimuths / 2 : azimuths); ++i) {
        // No direction cosines exist beyond 1 + |centre|.
        const auto radius = farthest(1 + glm::length(outline.centre), [&](double candidate) {
            return imaging.excess(outline.position, 0, outline.cosines(i, candidate));
        });
        outline.radii.push_back(radius.value_or(0));
    }
    for (std::size_t i = outline.radii.size(); i < azimuths; ++i) {
        outline.radii.push_back(outline.radii[azimuths - 1 - i]);
    }
    return outline;
}

std::vector<ConeRay> fill_cone(const Outline& outline, int panels) {
    // Gauss-Legendre nodes and weights over [-1, 1] (Abramowitz and Stegun, table 25.4), used in the share of the cone
    // that a ring encloses: exact for squared aberrations up to the 30th power of the pupil's radius.
    constexpr std::array<std::pair<double, double>, 8> rings = {{{-0.9602898564975363, 0.1012285362903763},
                                                                 {-0.7966664774136267, 0.2223810344533745},
                                                                 {-0.5255324099163290, 0.3137066458778873},
                                                                 {-0.1834346424956498, 0.3626837833783620},
                                                                 {0.1834346424956498, 0.3626837833783620},
                                                                 {0.5255324099163290, 0.3137066458778873},
                                                                 {0.7966664774136267, 0.2223810344533745},
                                                                 {0.9602898564975363, 0.1012285362903763}}};
    std::vector<ConeRay> rays;
    double total = 0;
    for (std::size_t i = 0; i < outline.radii.size(); ++i) {
        for (int panel = 0; panel < panels; ++panel) {
            for (const auto& [node, node_weight] : rings) {
                const double weight = node_weight * outline.radii[i] * outline.radii[i];
                const double share = (panel + 0.5 * (1 + node)) / panels;
                rays.push_back({outline.cosines(i, outline.radii[i] * std::sqrt(share)), weight});
                total += weight;
            }
        }
    }
    for (ConeRay& ray : rays) {
        ray.weight = total > 0 ? ray.weight / total : 0;
    }
    return rays;
}

// The landing points are almost linear in the height, so Gauss and Newton's method on their deviations from the
// centroid converges in two steps; three leave rounding only.
double least_spot(const Imaging& imaging, const Outline& outline) {
    // The step (mm) of the central difference: over a micrometre landing points deviate from a line by less than
    // rounding.
    constexpr double difference = 1e-3;
    struct Sample {
        glm::dvec2 landing;
        glm::dvec2 rate; // derivative of the landing point by height
        double weight;
    };
    const auto cone = fill_cone(outline);
    double height = 0;
    for (int step = 0; step < 3; ++step) {
        std::vector<Sample> samples;
        double total = 0;
        glm::dvec2 centroid(0);
        glm::dvec2 centroid_rate(0);
        for (const auto& [cosines, weight] : cone) {
            const auto below = imaging.trace(outline.position, height - difference, cosines, 0);
            const auto above = imaging.trace(outline.position, height + difference, cosines, 0);
            if (!below || !above) {
                continue;
            }
            const Sample sample{.landing = 0.5 * (below->position + above->position),
                                .rate = (above->position - below->position) / (2 * difference),
                                .weight = weight};
            samples.push_back(sample);
            total += weight;
            centroid += weight * sample.landing;
            centroid_rate += weight * sample.rate;
        }
        double numerator = 0;
        double denominator = 0;
        for (const Sample& sample : samples) {
            const glm::dvec2 deviation = sample.landing - centroid / total;
            const glm::dvec2 rate = sample.rate - centroid_rate / total;
            numerator += sample.weight * glm::dot(deviation, rate);
            denominator += sample.weight * glm::dot(rate, rate);
        }
        height -= denominator > 0 ? numerator / denominator : 0;
    }
    return height;
}

// A ray of position x and slope s on a plane at height t above the object plane crosses the paraxial entrance pupil at
// p x + (1 + p t) s, up to a factor, where x now stands on the object plane and p is the pupil's curvature. Light that
// reaches the detector starts within the field; the acceptance bound is the largest such crossing over field, azimuth
// and t. The crossing is convex in s and t, so its maximum lies on the rim of a cone and at an end of t.
double gate_radius(const Imaging& imaging, double field_radius, double lowest, double highest) {
    constexpr int field_points = 12;
    const auto largest_of = [&](glm::dvec2 position) {
        const Outline outline = outline_at(imaging, position);
        double largest = 0;
        for (std::size_t azimuth = 0; azimuth < outline.radii.size(); ++azimuth) {
            if (outline.radii[azimuth] == 0) {
                continue;
            }
            const glm::dvec2 cosines = outline.cosines(azimuth, outline.radii[azimuth]);
            const glm::dvec2 slope = cosines / std::sqrt(1 - glm::dot(cosines, cosines));
            for (const double t : {lowest, highest}) {
                largest = std::max(largest, glm::length(imaging.pupil_curvature * outline.position +
                                                        (1 + imaging.pupil_curvature * t) * slope));
            }
        }
        return largest;
    };
    double largest = 0;
    for (const glm::dvec2& direction : search_directions(imaging.symmetric)) {
        for (const double here : parallel_list(
                 field_points + 1, [&](int i) { return largest_of(direction * (field_radius * i / field_points)); })) {
            largest = std::max(largest, here);
        }
    }
    return search_margin * largest;
}

} // namespace vkfv::optics
