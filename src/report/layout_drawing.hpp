// The contents of the instrument's picture, in mm of the plane of drawing, before they are laid out on a page.
#pragma once

#include "optics/instrument/instrument.hpp"
#include "report/element_sections.hpp"
#include "report/layout_geometry.hpp"
#include "report/room_rays.hpp"

#include <string>
#include <vector>

namespace vkfv::report {

struct Shape {
    std::vector<glm::dvec2> points;
    bool closed = false;
    std::string attributes; // SVG attributes
};

struct Label {
    // Place of a label: beside the picture, with a leader; over the parts of a level arm; on the back of a mirror;
    // along a bracket.
    enum class Place { beside, over, behind, bracket } place = Place::beside;
    std::string text;
    Box part;
    glm::dvec2 normal{};          // direction towards the back of a mirror
    bool about_objective = false; // true: also in the enlarged picture of the objective
};

struct Drawing {
    std::vector<RoomRay> rays;
    std::vector<Shape> shapes; // from the back to the front
    std::vector<Label> labels;
    Box objective; // box of the specimen and of all up to the objective's back

    Box bounds() const;
    bool has(RoomRay::Bundle bundle) const;
};

Drawing draw_instrument(const optics::Instrument& instrument);

// Boxes of things that are drawn but are not elements.
struct DrawnBoxes {
    Box specimen;
    Box detector; // camera's body
    Box source;   // behind the illuminator
    std::vector<Box> ring_lights;
};

// The labels of the instrument's parts; parts with empty boxes have none.
std::vector<Label> label_parts(const optics::Instrument& instrument, const ElementSections& sections,
                               const DrawnBoxes& boxes);

} // namespace vkfv::report
