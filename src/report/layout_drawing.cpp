#include "report/layout_drawing.hpp"

#include "report/layout_style.hpp"
#include "report/mesh_sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace vkfv::report {

using glm::dvec2;
using glm::dvec3;
using optics::Element;
using optics::Part;
using optics::SurfaceRole;
using Kind = Element::Kind;

namespace {

constexpr const char* housing_look = "fill=\"#f0f0f0\" stroke=\"#cfcfcf\" stroke-width=\"0.8\"";
constexpr const char* lit_look = "fill=\"#f0c929\" stroke=\"#8a6d00\" stroke-width=\"0.8\"";
constexpr const char* ideal_lens_look = "stroke=\"#40627a\" stroke-width=\"1.8\"";

using Shapes = std::vector<Shape>;

void add(Shapes& shapes, std::vector<dvec2> points, bool closed, std::string attributes) {
    shapes.push_back({std::move(points), closed, std::move(attributes)});
}

Box box_of(const Shape& shape) {
    Box box;
    for (const dvec2& point : shape.points) {
        box.add(point);
    }
    return box;
}

// The fill colour of a glass, from crown to heavy flint.
std::string glass(double index) {
    const double depth = std::clamp((index - 1.4) / 0.5, 0.0, 1.0);
    const auto mixed = [&](double light, double dark) {
        return static_cast<int>(std::lround(light + depth * (dark - light)));
    };
    return fmt::format("#{:02x}{:02x}{:02x}", mixed(222, 128), mixed(239, 176), mixed(249, 214));
}

// Adds a tube as wide as the part's widest lens, tapered for an objective.
void add_housing(Shapes& shapes, const ElementSections& sections, Part part) {
    const auto& elements = sections.elements();
    std::size_t first = elements.size();
    std::size_t last = 0;
    std::size_t widest = 0;
    for (std::size_t i = 0; i < elements.size(); ++i) {
        if (elements[i].part == part) {
            widest = first == elements.size() || sections.radius(i) > sections.radius(widest) * 1.001 ? i : widest;
            first = std::min(first, i);
            last = i;
        }
    }
    if (first == last || first == elements.size() || !across(elements[first].pose)) {
        return;
    }
    const double wall = 0.15 * sections.radius(widest);
    const double radius = sections.radius(widest) + wall;
    const bool is_objective = part == Part::objective;
    const double nose = is_objective ? sections.radius(first) + wall : radius;
    const auto& front = elements[first].pose;
    const auto& back = elements[last].pose;
    const double before = std::min(sections.sag(first, sections.radius(first)), 0.0) - 0.5 * wall;
    const double behind = std::max(sections.sag(last, sections.radius(last)), 0.0) + wall;
    const auto& shoulder = elements[widest].pose;
    std::vector<dvec2> outline = {at(front, -nose, before)};
    if (is_objective && nose < radius) {
        outline.push_back(at(shoulder, -radius, 0));
    }
    outline.insert(outline.end(), {at(back, -radius, behind), at(back, radius, behind)});
    if (is_objective && nose < radius) {
        outline.push_back(at(shoulder, radius, 0));
    }
    outline.push_back(at(front, nose, before));
    add(shapes, std::move(outline), true, housing_look);
}

// Adds the camera's body, open towards the light; returns its box.
Box add_camera(Shapes& shapes, const ElementSections& sections) {
    const auto& elements = sections.elements();
    const auto& pose = elements.back().pose;
    if (!across(pose)) {
        return {};
    }
    const double wide = std::max(1.5 * sections.radius(elements.size() - 1), 0.035 * sections.extent());
    const double gap = 0.012 * sections.extent();
    const double deep = 0.05 * sections.extent();
    add(shapes, {at(pose, -wide, -gap), at(pose, -wide, deep), at(pose, wide, deep), at(pose, wide, -gap)}, false,
        fmt::format("fill=\"#f0f0f0\" stroke=\"{}\" stroke-width=\"1.2\" stroke-linejoin=\"round\"", grey));
    return box_of(shapes.back());
}

void add_immersion(Shapes& shapes, const ElementSections& sections, double index) {
    const auto& elements = sections.elements();
    const auto found = std::ranges::find(elements, Part::objective, &Element::part);
    if (index < 1.1 || found == elements.end()) {
        return;
    }
    const auto front = static_cast<std::size_t>(found - elements.begin());
    const double half = sections.radius(front);
    add(shapes, {{-half, 0}, {half, 0}, sections.on_surface(front, half), sections.on_surface(front, -half)}, true,
        fmt::format("fill=\"{}\" fill-opacity=\"0.6\"", glass(index)));
}

// The outline of the glass between a surface and the next one, ground to one diameter: each surface continues flat to
// the wider one's rim.
std::vector<dvec2> lens_outline(const ElementSections& sections, std::size_t i) {
    const double own = sections.radius(i);
    const double next = sections.radius(i + 1);
    const double radius = std::max(own, next);
    std::vector<dvec2> outline = sections.profile(i, -own, own);
    if (own < radius) {
        outline.insert(outline.begin(), sections.on_surface(i, -radius));
        outline.push_back(sections.on_surface(i, radius));
    }
    if (next < radius) {
        outline.push_back(sections.on_surface(i + 1, radius));
    }
    const auto second = sections.profile(i + 1, next, -next);
    outline.insert(outline.end(), second.begin(), second.end());
    if (next < radius) {
        outline.push_back(sections.on_surface(i + 1, -radius));
    }
    return outline;
}

void add_lenses(Shapes& shapes, const ElementSections& sections) {
    constexpr const char* edge = "stroke=\"#40627a\" stroke-width=\"0.9\" stroke-linejoin=\"round\"";
    const auto& elements = sections.elements();
    const auto coating = sections.cube_coating();
    if (coating) {
        const auto& front = elements[*coating - 1].pose;
        const double size = glm::length(elements[*coating + 1].pose.origin - front.origin);
        add(shapes,
            {at(front, -0.5 * size, 0), at(front, 0.5 * size, 0), at(front, 0.5 * size, size),
             at(front, -0.5 * size, size)},
            true, fmt::format("fill=\"{}\" {}", glass(elements[*coating].surface.index_before), edge));
    }
    for (std::size_t i = 0; i + 1 < elements.size(); ++i) {
        const bool is_glass = elements[i].part == elements[i + 1].part && elements[i].surface.index_after > 1 &&
                              elements[i].surface.index_after == elements[i + 1].surface.index_before;
        const bool in_cube = coating && elements[i].part == Part::beam_splitter;
        if (!is_glass || in_cube) {
            continue;
        }
        const std::string attributes = fmt::format("fill=\"{}\" {}", glass(elements[i].surface.index_after), edge);
        const bool is_cut = across(elements[i].pose).has_value();
        add(shapes, is_cut ? lens_outline(sections, i) : rim(elements[i].pose, sections.radius(i)), true, attributes);
    }
}

// Adds the section of a mesh by the plane of drawing, or else the box of its outline; returns the box around it.
Box add_mesh(Shapes& shapes, const optics::PlacedMesh& mesh) {
    using MeshKind = optics::MeshElement::Kind;
    const bool is_glass = mesh.kind == MeshKind::glass;
    const std::string line = fmt::format("stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\"",
                                         is_glass ? "#40627a" : ink, mesh.kind == MeshKind::mirror ? 2.0 : 0.9);
    const std::string fill = is_glass ? fmt::format("fill=\"{}\" ", glass(mesh.surface.index_after))
                             : mesh.kind == MeshKind::absorber && mesh.closed ? "fill=\"#8a8a8a\" "
                                                                              : "";
    Box drawn;
    for (const SectionLine& section : section_of(mesh.facets)) {
        add(shapes, section.points, section.closed, "class=\"mesh\" " + (section.closed ? fill : "") + line);
        drawn.add(box_of(shapes.back()));
    }
    if (drawn.empty()) {
        for (const dvec3& vertex : mesh.facets.vertices) {
            drawn.add(flat(vertex));
        }
        add(shapes, {drawn.lower, {drawn.upper.x, drawn.lower.y}, drawn.upper, {drawn.lower.x, drawn.upper.y}}, true,
            "class=\"mesh\" stroke-dasharray=\"3 3\" " + line);
    }
    return drawn;
}

void add_rays(Shapes& shapes, const std::vector<RoomRay>& rays) {
    for (const BundleStyle& style : bundle_styles) {
        for (const RoomRay& ray : rays) {
            if (ray.bundle == style.bundle) {
                std::vector<dvec2> points;
                for (const dvec3& vertex : ray.vertices) {
                    points.push_back(flat(vertex));
                }
                add(shapes, std::move(points), false,
                    fmt::format("class=\"ray\" stroke=\"{}\" stroke-width=\"0.8\" stroke-opacity=\"0.85\"",
                                style.colour));
            }
        }
    }
}

// Adds the blades of a stop.
void add_stop(Shapes& shapes, const ElementSections& sections, std::size_t i) {
    const Element& element = sections.elements()[i];
    const double radius = sections.radius(i);
    const bool limits = element.name.role == SurfaceRole::aperture_stop || element.name.role == SurfaceRole::field_stop;
    if (!is_limited(element) || !(limits || element.kind == Kind::stop) || !across(element.pose)) {
        return;
    }
    const double outer = std::max(1.12 * sections.part_radius(element.part), radius + 0.004 * sections.extent());
    const double height = sections.sag(i, radius);
    for (const double side : {-1.0, 1.0}) {
        add(shapes, {at(element.pose, side * radius, height), at(element.pose, side * outer, height)}, false,
            fmt::format("stroke=\"{}\" stroke-width=\"{}\"", ink, limits ? 2.6 : 1.4));
    }
}

void add_coating(Shapes& shapes, const ElementSections& sections, std::size_t i) {
    const auto& elements = sections.elements();
    const double radius = sections.radius(i);
    const double half =
        sections.cube_coating()
            ? std::min(radius, std::sqrt(0.5) * glm::length(elements[i + 1].pose.origin - elements[i - 1].pose.origin))
            : radius;
    add(shapes, {at(elements[i].pose, -half, 0), at(elements[i].pose, half, 0)}, false,
        "stroke=\"#7a3e9d\" stroke-width=\"2\"");
}

// Adds a mirror with hatches on its back.
void add_mirror(Shapes& shapes, const ElementSections& sections, std::size_t i) {
    const auto& pose = sections.elements()[i].pose;
    const double radius = sections.radius(i);
    if (!across(pose)) {
        add(shapes, rim(pose, radius), true, fmt::format("fill=\"#e4e4e4\" stroke=\"{}\" stroke-width=\"1.6\"", ink));
        return;
    }
    add(shapes, {at(pose, -radius, 0), at(pose, radius, 0)}, false,
        fmt::format("stroke=\"{}\" stroke-width=\"2\"", ink));
    const double hatch = std::max(0.12 * radius, 0.006 * sections.extent());
    const int hatches = std::clamp(static_cast<int>(2 * radius / hatch), 4, 40);
    for (int k = 0; k < hatches; ++k) {
        const double r = radius * (2.0 * (k + 0.5) / hatches - 1);
        add(shapes, {at(pose, r, 0), at(pose, r - hatch, sections.back(i) * hatch)}, false,
            fmt::format("stroke=\"{}\" stroke-width=\"0.8\"", grey));
    }
}

// Adds an ideal lens with arrow heads, outward if it is positive.
void add_ideal_lens(Shapes& shapes, const ElementSections& sections, std::size_t i) {
    const Element& element = sections.elements()[i];
    const auto& pose = element.pose;
    const double radius = sections.radius(i);
    add(shapes, {at(pose, -radius, 0), at(pose, radius, 0)}, false, ideal_lens_look);
    const double head = std::min(0.2 * radius, 0.015 * sections.extent());
    const double back = element.surface.power > 0 ? -head : head;
    for (const double side : {-1.0, 1.0}) {
        add(shapes,
            {at(pose, side * (radius + back), -head), at(pose, side * radius, 0),
             at(pose, side * (radius + back), head)},
            false, ideal_lens_look);
    }
}

void add_flat_elements(Shapes& shapes, const ElementSections& sections) {
    for (std::size_t i = 0; i < sections.elements().size(); ++i) {
        add_stop(shapes, sections, i);
        switch (sections.elements()[i].kind) {
        case Kind::splitter:
            add_coating(shapes, sections, i);
            break;
        case Kind::mirror:
            add_mirror(shapes, sections, i);
            break;
        case Kind::ideal_lens:
            add_ideal_lens(shapes, sections, i);
            break;
        case Kind::surface:
        case Kind::stop:
        case Kind::detector:
            break;
        }
    }
}

// Adds a slab, and the field on it; returns its box.
Box add_specimen(Shapes& shapes, const ElementSections& sections, double field) {
    const double half = std::max(1.3 * sections.part_radius(Part::objective), 0.02 * sections.extent());
    const double thickness = sections.slab_thickness();
    add(shapes, {{-half, 0}, {half, 0}, {half, -thickness}, {-half, -thickness}}, true,
        "fill=\"#d9cdb8\" stroke=\"#7d6b4a\" stroke-width=\"0.9\"");
    const Box slab = box_of(shapes.back());
    add(shapes, {{-field, 0}, {field, 0}}, false, "class=\"field\" stroke=\"#a3123a\" stroke-width=\"3\"");
    return slab;
}

void add_detector(Shapes& shapes, const optics::Pose& pose, double half_size) {
    if (across(pose)) {
        add(shapes, {at(pose, -half_size, 0), at(pose, half_size, 0)}, false,
            fmt::format("class=\"detector\" stroke=\"{}\" stroke-width=\"4\"", ink));
    }
}

// Adds both sections of the ring's band by the plane of drawing, lit where the segment there is lit.
Box add_ring(Shapes& shapes, const physics::f64::RingLight& ring, double extent) {
    Box drawn;
    const double depth = 0.012 * extent; // depth of its body, behind the band
    for (const double side : {-1.0, 1.0}) {
        const double turns = side > 0 ? 0.25 : 0.75;
        const int segment = static_cast<int>(turns * ring.segments);
        const bool on = (ring.switched_on >> segment & 1u) != 0;
        const dvec2 outward(side * ring.elevation_cosine, ring.elevation_sine);
        const dvec2 along(-side * ring.elevation_sine, ring.elevation_cosine);
        const dvec2 middle = ring.distance * outward;
        const dvec2 inner = middle + ring.half_width * along;
        const dvec2 outer = middle - ring.half_width * along;
        add(shapes, {inner, outer, outer + depth * outward, inner + depth * outward}, true,
            on ? lit_look : "fill=\"#e4e4e4\" stroke=\"#8a8a8a\" stroke-width=\"0.8\"");
        drawn.add(box_of(shapes.back()));
    }
    return drawn;
}

Box add_source(Shapes& shapes, const optics::Pose& pose, double radius, double extent) {
    if (!across(pose)) {
        add(shapes, rim(pose, radius), true, lit_look);
        return {};
    }
    const double wide = std::max(1.5 * radius, 0.012 * extent);
    add(shapes, {at(pose, -wide, 0), at(pose, wide, 0), at(pose, wide, -wide), at(pose, -wide, -wide)}, true,
        "fill=\"#f0f0f0\" stroke=\"#8a8a8a\" stroke-width=\"1\"");
    const Box body = box_of(shapes.back());
    add(shapes, {at(pose, -radius, 0), at(pose, radius, 0)}, false,
        "class=\"source\" stroke=\"#e6ac00\" stroke-width=\"4\"");
    return body;
}

Box objective_region(const ElementSections& sections) {
    Box box = sections.part_box(Part::objective);
    box.add(sections.part_box(Part::cover_glass));
    const double half = 0.5 * box.size().x;
    box.add(dvec2(-half, 0));
    box.add(dvec2(half, -sections.slab_thickness()));
    return box;
}

} // namespace

Box Drawing::bounds() const {
    Box box;
    for (const Shape& shape : shapes) {
        box.add(box_of(shape));
    }
    return box;
}

bool Drawing::has(RoomRay::Bundle bundle) const {
    return std::ranges::find(rays, bundle, &RoomRay::bundle) != rays.end();
}

Drawing draw_instrument(const optics::Instrument& instrument) {
    const auto& constants = instrument.constants;
    Drawing drawing;
    drawing.rays = trace_room_rays(instrument);
    const ElementSections sections(instrument, drawing.rays);
    Shapes& shapes = drawing.shapes;
    DrawnBoxes boxes;
    for (const optics::Instrument* light : instrument.lights()) {
        if ((light->features & physics::f64::FEATURE_RING) != 0) {
            boxes.ring_lights.push_back(add_ring(shapes, light->constants.ring, sections.extent()));
        }
    }
    add_housing(shapes, sections, Part::objective);
    add_housing(shapes, sections, Part::tube_lens);
    boxes.detector = add_camera(shapes, sections);
    add_immersion(shapes, sections, constants.specimen_index);
    add_lenses(shapes, sections);
    std::vector<Label> mesh_labels;
    for (const optics::PlacedMesh& mesh : instrument.meshes) {
        mesh_labels.push_back({.text = mesh.name, .part = add_mesh(shapes, mesh)});
    }
    add_rays(shapes, drawing.rays);
    add_flat_elements(shapes, sections);
    boxes.specimen = add_specimen(shapes, sections, instrument.first_order.field_edge);
    add_detector(shapes, instrument.elements.back().pose, constants.detector_half_height);
    if ((instrument.features & physics::f64::FEATURE_RING) == 0) {
        const bool is_rectangle = (instrument.features & physics::f64::FEATURE_RECTANGLE) != 0;
        boxes.source =
            add_source(shapes, instrument.source_pose,
                       is_rectangle ? constants.source_half_height : constants.source_radius, sections.extent());
    }
    drawing.labels = label_parts(instrument, sections, boxes);
    drawing.labels.insert(drawing.labels.end(), mesh_labels.begin(), mesh_labels.end());
    drawing.objective = objective_region(sections);
    return drawing;
}

} // namespace vkfv::report
