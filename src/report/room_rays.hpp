// Rays through the elements as they stand in space, folded by mirrors and the splitter, for drawing.
#pragma once

#include "optics/instrument/instrument.hpp"

#include <glm/glm.hpp>

#include <vector>

namespace vkfv::report {

struct RoomRay {
    enum class Bundle { illumination_centre, illumination_rim, ring_light, imaging_axis, imaging_edge };
    static constexpr int no_element = -1;

    Bundle bundle = Bundle::imaging_axis;
    std::vector<glm::dvec3> vertices; // mm, in the frame of optics::Element
    // The element of Instrument::elements on which each vertex lies; no_element: the source or the plane of best focus.
    // An ideal lens has two vertices: light enters one principal plane and leaves the other, which coincide.
    std::vector<int> elements;
};

// Traces rays at the reference wavelength that pass all apertures, each bundle from margin to margin of its cone.
// Imaging: from the axis and the field's edge at +y to the detector. Illumination: from the middle of the source and
// its lit rim to the plane of best focus; a ring light's from the lit segments nearest to the plane of drawing. Rays
// lie in the y-z plane of the object or source, unless the elements lead them out of it.
std::vector<RoomRay> trace_room_rays(const optics::Instrument& instrument);

} // namespace vkfv::report
