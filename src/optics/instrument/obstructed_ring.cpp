#include "optics/instrument/obstructed_ring.hpp"

#include "core/mathematics/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vkfv::optics {

namespace {

// Half a section through the objective: radii by height above the plane of best focus, mm.
struct Body {
    std::vector<glm::dvec2> outline; // height, radius; ascending

    double radius_at(double height) const {
        if (outline.empty() || height < outline.front().x || height > outline.back().x) {
            return 0;
        }
        const auto above = std::ranges::lower_bound(outline, height, {}, [](glm::dvec2 point) { return point.x; });
        if (above == outline.begin() || above->x == height) {
            return above->y;
        }
        const glm::dvec2 below = *(above - 1);
        return std::lerp(below.y, above->y, (height - below.x) / (above->x - below.x));
    }
};

Body body_of(const Instrument& instrument) {
    Body body;
    for (const Element& element : instrument.elements) {
        const double radius = std::sqrt(element.surface.semi_diameter_squared);
        // A surface without an edge says nothing of its lens.
        if (element.part != Part::objective || element.kind == Element::Kind::stop ||
            (element.surface.flags & physics::f64::SURFACE_CLIPPED) == 0 || !std::isfinite(radius)) {
            continue;
        }
        const double bend = element.surface.curvature * radius;
        const double sag = std::abs(bend) < 1 ? bend * radius / (1 + std::sqrt(1 - bend * bend)) : radius;
        for (const glm::dvec3 inside : {glm::dvec3(radius, 0, sag), glm::dvec3(-radius, 0, sag)}) {
            const glm::dvec3 point = element.pose.point(inside);
            body.outline.emplace_back(point.z, std::hypot(point.x, point.y));
        }
    }
    std::ranges::sort(body.outline, {}, [](glm::dvec2 point) { return point.x; });
    return body;
}

// True if the body stands in the way of the light that goes to the focus from the rim of the luminous band that is
// nearest to the axis.
bool meets(const Body& body, const RingLightDescription& ring, double elevation) {
    const double radius = ring.distance * std::cos(elevation) - 0.5 * ring.width * std::sin(elevation);
    const double height = ring.distance * std::sin(elevation) + 0.5 * ring.width * std::cos(elevation);
    constexpr int steps = 400; // along the light's way
    for (int step = 1; step <= steps; ++step) {
        const double share = static_cast<double>(step) / steps;
        if (share * radius < body.radius_at(share * height)) {
            return true;
        }
    }
    return false;
}

} // namespace

std::vector<Warning> warnings_of_obstructed_rings(const InstrumentDescription& description,
                                                  const Instrument& instrument) {
    std::vector<Warning> warnings;
    const Body body = body_of(instrument);
    if (body.outline.empty()) {
        return warnings;
    }
    for (const SourceDescription* source : description.sources()) {
        if (!source->ring || !meets(body, *source->ring, source->ring->elevation)) {
            continue;
        }
        constexpr double step = 0.5; // degrees
        const double now = source->ring->elevation / radians_per_degree;
        double free = std::floor(now / step) * step;
        while (free > 0 && meets(body, *source->ring, free * radians_per_degree)) {
            free -= step;
        }
        const std::string remedy = free > 0 ? fmt::format("At this distance the light is free up to {:.4g} deg", free)
                                            : std::string("A shorter distance_mm brings it below the objective");
        warnings.push_back(
            {.code = "ring-in-objective",
             .key = source->key + (free > 0 ? ".elevation_deg" : ".distance_mm"),
             .value = number_text(free > 0 ? now : source->ring->distance),
             .works = free > 0 ? number_text(free) : "a shorter one",
             .sentence = fmt::format(
                 "The ring light stands in the objective, or the objective in its light's way: {:.4g} mm from the axis "
                 "and {:.4g} mm above the focus, with lenses up to {:.4g} mm from the axis from {:.4g} mm above it on. "
                 "vkfv traces its light as if the objective were not there. {}.",
                 source->ring->distance * std::cos(source->ring->elevation),
                 source->ring->distance * std::sin(source->ring->elevation),
                 std::ranges::max(body.outline, {}, [](glm::dvec2 point) { return point.y; }).y, body.outline.front().x,
                 remedy)});
    }
    return warnings;
}

} // namespace vkfv::optics
