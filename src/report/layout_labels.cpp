#include "report/layout_drawing.hpp"

#include <fmt/format.h>

#include <utility>

namespace vkfv::report {

using optics::Element;
using optics::Part;
using optics::SurfaceRole;
using Kind = Element::Kind;

namespace {

Label label(std::string text, const Box& part, bool upright, bool about_objective = false) {
    return {.place = upright ? Label::Place::beside : Label::Place::over,
            .text = std::move(text),
            .part = part,
            .about_objective = about_objective};
}

// The label of an element's part, "objective 10x_0.28".
std::string text_of(const Element& element) {
    return fmt::format("{} {}", name_of(element.part), element.name.of);
}

} // namespace

std::vector<Label> label_parts(const optics::Instrument& instrument, const ElementSections& sections,
                               const DrawnBoxes& boxes) {
    const auto& elements = sections.elements();
    std::vector<Label> labels;
    for (std::size_t i = 0; i < elements.size(); ++i) {
        const Element& element = elements[i];
        const Part part = element.part;
        const SurfaceRole role = element.name.role;
        Box own;
        own.add(sections.on_surface(i, -sections.radius(i)));
        own.add(sections.on_surface(i, sections.radius(i)));
        const bool upright = is_upright(element.pose);
        const bool starts = i == 0 || elements[i - 1].part != part;
        if (starts && (part == Part::objective || part == Part::tube_lens)) {
            labels.push_back(label(text_of(element), sections.part_box(part), upright, part == Part::objective));
        } else if (starts && part == Part::cover_glass) {
            labels.push_back(label(name_of(part), sections.part_box(part), upright, true));
        } else if (starts && part == Part::illuminator) {
            const std::size_t lens = role == SurfaceRole::illumination_aperture ? i + 1 : i;
            labels.push_back(
                {.place = Label::Place::bracket, .text = text_of(elements[lens]), .part = sections.part_box(part)});
        } else if (element.kind == Kind::mirror) {
            labels.push_back({.place = Label::Place::behind,
                              .text = name_of(part),
                              .part = own,
                              .normal = flat(element.pose.axes[2]) * sections.back(i)});
        } else if (element.kind == Kind::splitter) {
            Box end;
            end.add(sections.on_surface(i, 0.8 * sections.radius(i))); // the lower end of the coating
            labels.push_back(label(name_of(part), sections.cube_coating() ? sections.part_box(part) : end, true));
        }
        if (role != SurfaceRole::refracting && is_limited(element)) {
            labels.push_back(label(name_of(role), own, upright, role == SurfaceRole::aperture_stop));
        }
    }
    labels.push_back(label("specimen", boxes.specimen, true, true));
    labels.push_back(label("detector", boxes.detector, is_upright(elements.back().pose)));
    labels.push_back(label("source", boxes.source, is_upright(instrument.source_pose)));
    for (const Box& ring : boxes.ring_lights) {
        labels.push_back(label("ring light", ring, true));
    }
    std::erase_if(labels, [](const Label& drawn) { return drawn.part.empty(); });
    return labels;
}

} // namespace vkfv::report
