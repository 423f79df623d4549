#include "report/element_sections.hpp"

#include "core/mathematics/units.hpp"

#include <algorithm>
#include <cmath>

namespace vkfv::report {

using glm::dvec2;
using glm::dvec3;
using optics::Element;
using Kind = Element::Kind;

std::optional<dvec3> across(const optics::Pose& pose) {
    const dvec3 direction = glm::cross(dvec3(1, 0, 0), pose.axes[2]);
    const double length = glm::length(direction);
    constexpr double least = 0.5; // sine of 30 degrees
    return length < least ? std::nullopt : std::optional(direction / length);
}

dvec2 at(const optics::Pose& pose, double radius, double height) {
    return flat(pose.origin + across(pose).value_or(dvec3(0, 1, 0)) * radius + pose.axes[2] * height);
}

std::vector<dvec2> rim(const optics::Pose& pose, double radius) {
    std::vector<dvec2> points;
    constexpr int pieces = 48;
    for (int k = 0; k < pieces; ++k) {
        const double angle = 2 * pi * k / pieces;
        points.push_back(flat(pose.point({radius * std::cos(angle), radius * std::sin(angle), 0})));
    }
    return points;
}

bool is_upright(const optics::Pose& pose) {
    return std::abs(pose.axes[2].z) >= std::abs(pose.axes[2].y);
}

bool is_limited(const Element& element) {
    return (element.surface.flags & physics::f64::SURFACE_CLIPPED) != 0;
}

ElementSections::ElementSections(const optics::Instrument& instrument, const std::vector<RoomRay>& rays)
    : elements_(instrument.elements), backs_(instrument.elements.size(), 1) {
    std::vector<double> lit(elements_.size(), 0);
    for (const RoomRay& ray : rays) {
        for (std::size_t v = 0; v < ray.vertices.size(); ++v) {
            if (ray.elements[v] != RoomRay::no_element) {
                const auto i = static_cast<std::size_t>(ray.elements[v]);
                const dvec3 inside =
                    glm::transpose(elements_[i].pose.axes) * (ray.vertices[v] - elements_[i].pose.origin);
                lit[i] = std::max(lit[i], std::hypot(inside.x, inside.y));
                backs_[i] = glm::dot(ray.vertices[v] - ray.vertices[v - 1], elements_[i].pose.axes[2]) < 0 ? -1 : 1;
            }
        }
    }
    for (std::size_t i = 0; i < elements_.size(); ++i) {
        const auto& surface = elements_[i].surface;
        constexpr double spare = 1.25;
        const double equator = std::sqrt(std::max(0.0, 1 + surface.conic)) * std::abs(surface.curvature);
        double radius = is_limited(elements_[i]) ? std::sqrt(surface.semi_diameter_squared) : spare * lit[i];
        if (elements_[i].kind == Kind::detector) {
            radius = instrument.constants.detector_half_height;
        }
        radii_.push_back(equator > 0 ? std::min(radius, 0.999 / equator) : radius);
    }
    for (const Element& element : elements_) {
        extent_ = std::max(extent_, glm::length(flat(element.pose.origin)));
    }
}

double ElementSections::sag(std::size_t i, double radius) const {
    return physics::f64::asphere_sag(elements_[i].surface, radius * radius).sag;
}

dvec2 ElementSections::on_surface(std::size_t i, double radius) const {
    return at(elements_[i].pose, radius, sag(i, std::clamp(radius, -radii_[i], radii_[i])));
}

std::vector<dvec2> ElementSections::profile(std::size_t i, double from, double to) const {
    const bool plane =
        elements_[i].surface.curvature == 0 && (elements_[i].surface.flags & physics::f64::SURFACE_ASPHERIC) == 0;
    const int pieces = plane ? 1 : 28;
    std::vector<dvec2> points;
    for (int k = 0; k <= pieces; ++k) {
        points.push_back(on_surface(i, from + (to - from) * k / pieces));
    }
    return points;
}

Box ElementSections::part_box(optics::Part part) const {
    Box box;
    for (std::size_t i = 0; i < elements_.size(); ++i) {
        if (elements_[i].part == part) {
            box.add(on_surface(i, -radii_[i]));
            box.add(on_surface(i, 0));
            box.add(on_surface(i, radii_[i]));
        }
    }
    return box;
}

double ElementSections::part_radius(optics::Part part) const {
    double radius = 0;
    for (std::size_t i = 0; i < elements_.size(); ++i) {
        radius = std::max(radius, elements_[i].part == part ? radii_[i] : 0.0);
    }
    return radius;
}

std::optional<std::size_t> ElementSections::cube_coating() const {
    for (std::size_t i = 1; i + 1 < elements_.size(); ++i) {
        if (elements_[i].kind == Kind::splitter && elements_[i - 1].part == optics::Part::beam_splitter &&
            elements_[i - 1].surface.index_after > 1 && elements_[i + 1].part == optics::Part::beam_splitter) {
            return i;
        }
    }
    return std::nullopt;
}

} // namespace vkfv::report
