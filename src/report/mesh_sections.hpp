// What the plane of drawing, x = 0, cuts of a mesh.
#pragma once

#include "optics/train/mesh_element.hpp"

#include <glm/glm.hpp>

#include <vector>

namespace vkfv::report {

struct SectionLine {
    std::vector<glm::dvec2> points; // (y, z), mm
    bool closed = false;
};

// Of a closed mesh all lines are closed. Empty: the plane meets it nowhere.
std::vector<SectionLine> section_of(const optics::Facets& facets);

} // namespace vkfv::report
