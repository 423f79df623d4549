// The instrument's elements as the non-sequential trace takes them: with mounts and barrels, so that no light passes
// beside the lenses.
#pragma once

#include "optics/instrument.hpp"

#include <glm/glm.hpp>

#include <string>
#include <vector>

namespace vkfv::optics {

struct Room {
    std::vector<physics::f64::Element> elements; // frame and unit: Element of instrument.hpp
    std::vector<std::string> names;              // "objective: 10x_0.28 3", ...
    physics::f64::SourceFrame source;

    struct Box {
        glm::dvec3 lower;
        glm::dvec3 upper;
    };
    Box bounds(std::size_t element) const; // encloses its surface, mount and rim
};

Room furnish(const Instrument& instrument);

// The nearest element that a ray meets, for physics::trace_nonsequential on the host. Tries every element.
physics::f64::ElementHit nearest_element(const Room& room, glm::dvec3 origin, glm::dvec3 direction, int left);

} // namespace vkfv::optics
