// Sections of a mesh by the plane of drawing, x = 0.
#pragma once

#include "optics/train/mesh_element.hpp"

#include <glm/glm.hpp>

#include <vector>

namespace vkfv::report {

struct SectionLine {
    std::vector<glm::dvec2> points; // (y, z), mm
    bool closed = false;
};

// The section of a mesh, empty if the plane does not meet it. All lines of a closed mesh are closed.
std::vector<SectionLine> section_of(const optics::Facets& facets);

} // namespace vkfv::report
