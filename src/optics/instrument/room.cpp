#include "optics/instrument/room.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace vkfv::optics {

namespace {

using physics::f64::Surface;
using Kind = Element::Kind;

// Free radius (mm) of elements without a semi-diameter: wider than any beam in a microscope's infinity space.
constexpr double unlimited_radius = 25;
// A barrel is wider than its lenses by this share and this length (mm).
constexpr double barrel_share = 1.05;
constexpr double barrel_gap = 0.5;

std::uint32_t kind_of(Kind kind) {
    switch (kind) {
    case Kind::stop:
        return physics::f64::ELEMENT_STOP;
    case Kind::mirror:
        return physics::f64::ELEMENT_MIRROR;
    case Kind::splitter:
        return physics::f64::ELEMENT_SPLITTER;
    case Kind::ideal_lens:
        return physics::f64::ELEMENT_IDEAL_LENS;
    case Kind::detector:
        return physics::f64::ELEMENT_DETECTOR;
    case Kind::surface:
        break;
    }
    return physics::f64::ELEMENT_INTERFACE;
}

bool is_limited(const Surface& surface) {
    return (surface.flags & physics::f64::SURFACE_CLIPPED) != 0;
}

// The largest radius (mm) at which the surface is evaluated.
double reach(const Surface& surface) {
    // The limit stays inside the equator, where the slope is infinite.
    constexpr double short_of_equator = 0.98;
    const double root = std::sqrt(std::max(0.0, 1 + surface.conic)) * std::abs(surface.curvature);
    return root > 0 ? short_of_equator / root : std::numeric_limits<double>::infinity();
}

double free_radius(const Element& element, const Instrument& instrument) {
    if (element.kind == Kind::detector) {
        // A compressed image shows light that arrives beyond the detector's corners.
        const auto& constants = instrument.constants;
        return instrument.image_reach * std::hypot(constants.detector_half_width, constants.detector_half_height);
    }
    const double limit =
        is_limited(element.surface) ? std::sqrt(element.surface.semi_diameter_squared) : unlimited_radius;
    return std::min(limit, reach(element.surface));
}

bool has_barrel(Part part) {
    return part == Part::objective || part == Part::tube_lens || part == Part::illuminator;
}

void stand(physics::f64::Element& element, const Pose& pose) {
    element.origin = pose.origin;
    element.axis_x = pose.axes[0];
    element.axis_y = pose.axes[1];
    element.axis_z = pose.axes[2];
}

} // namespace

Room furnish(const Instrument& instrument) {
    using namespace physics::f64;
    Room room;
    const Pose& source = instrument.source_pose;
    room.source = {source.origin, source.axes[0], source.axes[1], source.axes[2]};
    std::map<Part, double> widest; // largest free radius in each part
    for (const optics::Element& element : instrument.elements) {
        double& radius = widest[element.part];
        radius = std::max(radius, free_radius(element, instrument));
    }
    for (const optics::Element& placed : instrument.elements) {
        const bool patterned = (placed.surface.flags & SURFACE_LIGHT_FIELD) != 0;
        if (placed.kind == Kind::stop && !is_limited(placed.surface) && !patterned) {
            continue; // an open stop affects no ray
        }
        physics::f64::Element element{};
        element.surface = placed.surface;
        element.kind = kind_of(placed.kind);
        const double radius = free_radius(placed, instrument);
        element.surface.semi_diameter_squared = radius * radius;
        stand(element, placed.pose);
        const bool mounted = is_limited(placed.surface) || has_barrel(placed.part);
        element.outer_radius = mounted ? barrel_share * widest[placed.part] + barrel_gap : radius;
        // Beyond its design aperture an aspheric polynomial may take any form.
        const bool aspheric = (placed.surface.flags & SURFACE_ASPHERIC) != 0;
        element.rim_radius = aspheric ? radius : std::min(element.outer_radius, reach(placed.surface));
        element.rim_height = asphere_sag(placed.surface, element.rim_radius * element.rim_radius).sag;
        element.transmittance = placed.kind == Kind::splitter ? instrument.splitter_transmittance : 1;
        room.elements.push_back(element);
        room.names.push_back(fmt::format("{}: {}", name_of(placed.part), placed.name.text()));
    }
    // Each part with a barrel gets one from its first vertex to its last.
    for (std::size_t first = 0; first < instrument.elements.size();) {
        const optics::Element& start = instrument.elements[first];
        std::size_t last = first;
        while (last + 1 < instrument.elements.size() && instrument.elements[last + 1].part == start.part) {
            ++last;
        }
        const glm::dvec3 axis = start.pose.axes[2];
        const double length = glm::dot(instrument.elements[last].pose.origin - start.pose.origin, axis);
        if (has_barrel(start.part) && length > 0) {
            physics::f64::Element barrel{};
            barrel.kind = ELEMENT_BARREL;
            barrel.outer_radius = barrel_share * widest[start.part] + barrel_gap;
            barrel.barrel_length = length;
            stand(barrel, start.pose);
            room.elements.push_back(barrel);
            room.names.push_back(fmt::format("{}: barrel", name_of(start.part)));
        }
        first = last + 1;
    }
    room.surfaces = room.elements.size();
    for (const PlacedMesh& mesh : instrument.meshes) {
        room.add_mesh(mesh);
    }
    std::map<std::string, int> meshes; // number of meshes of each file
    for (std::size_t k = room.surfaces; k < room.names.size(); ++k) {
        if (const int number = ++meshes[room.names[k]]; number > 1) {
            room.names[k] += fmt::format(" ({})", number);
        }
    }
    return room;
}

BoxTree::Box bounds_of(const physics::f64::Facet& facet) {
    return {glm::min(facet.corner_a, glm::min(facet.corner_b, facet.corner_c)),
            glm::max(facet.corner_a, glm::max(facet.corner_b, facet.corner_c))};
}

void Room::add_mesh(const PlacedMesh& mesh) {
    physics::f64::Element element{};
    element.kind = mesh.kind == MeshElement::Kind::glass    ? physics::f64::ELEMENT_INTERFACE
                   : mesh.kind == MeshElement::Kind::mirror ? physics::f64::ELEMENT_MIRROR
                                                            : physics::f64::ELEMENT_ABSORBER;
    element.surface = mesh.surface;
    stand(element, Pose{});
    const auto index = static_cast<int>(elements.size());
    elements.push_back(element);
    names.push_back(fmt::format("mesh: {}", mesh.name));
    const std::vector<glm::dvec3> normals = normals_of(mesh.facets);
    const auto corner = [&](std::uint32_t vertex) { return glm::dvec3(glm::vec3(mesh.facets.vertices[vertex])); };
    for (std::size_t k = 0; k < mesh.facets.triangles.size(); ++k) {
        const glm::uvec3& triangle = mesh.facets.triangles[k];
        facets.push_back({.corner_a = corner(triangle.x),
                          .corner_b = corner(triangle.y),
                          .corner_c = corner(triangle.z),
                          .normal = normals[k],
                          .element = index,
                          .closed = mesh.closed ? 1u : 0u});
    }
}

void Room::grow_facet_tree() {
    std::vector<Box> boxes;
    boxes.reserve(facets.size());
    for (const physics::f64::Facet& facet : facets) {
        boxes.push_back(bounds_of(facet));
    }
    facet_tree = BoxTree(boxes);
}

Room::Box Room::bounds(std::size_t index) const {
    const physics::f64::Element& element = elements[index];
    double low = std::min(0.0, element.rim_height);
    double high = std::max({0.0, element.rim_height, element.barrel_length});
    if ((element.surface.flags & physics::f64::SURFACE_ASPHERIC) != 0) {
        constexpr int samples = 64; // more than a polynomial of degree 16 has extrema
        for (int i = 1; i < samples; ++i) {
            const double r = element.rim_radius * i / samples;
            const double sag = physics::f64::asphere_sag(element.surface, r * r).sag;
            low = std::min(low, sag);
            high = std::max(high, sag);
        }
        const double margin = 0.01 * (high - low);
        low -= margin;
        high += margin;
    }
    Box box{glm::dvec3(std::numeric_limits<double>::infinity()), glm::dvec3(-std::numeric_limits<double>::infinity())};
    for (int corner = 0; corner < 8; ++corner) {
        const double x = (corner & 1) != 0 ? element.outer_radius : -element.outer_radius;
        const double y = (corner & 2) != 0 ? element.outer_radius : -element.outer_radius;
        const double z = (corner & 4) != 0 ? high : low;
        const glm::dvec3 point = element.origin + element.axis_x * x + element.axis_y * y + element.axis_z * z;
        box.lower = glm::min(box.lower, point);
        box.upper = glm::max(box.upper, point);
    }
    return box;
}

physics::f64::ElementHit nearest_element(const Room& room, glm::dvec3 origin, glm::dvec3 direction,
                                         physics::f64::PathPlace from) {
    using namespace physics::f64;
    const double least = least_distance(origin);
    NearestElement nearest = no_element(std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < room.surfaces; ++i) {
        const int index = static_cast<int>(i);
        const ElementMeeting meeting = meet_element(room.elements[i], origin, direction, index == from.element, least);
        if (meeting.found && meeting.distance < nearest.hit.distance) {
            nearest.hit = {.index = index, .facet = -1, .distance = meeting.distance};
        }
    }
    const RayFrame frame = ray_frame(origin, direction);
    room.facet_tree.walk(origin, direction, nearest.hit.distance, [&](std::uint32_t facet, double) {
        nearest = consider_facet(nearest, frame, room.facets[facet], static_cast<int>(facet), from, least);
        return nearest.hit.distance;
    });
    return nearest_hit(nearest, from);
}

} // namespace vkfv::optics
