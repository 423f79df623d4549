// Rays through the elements as they stand in the room, folded by mirrors and the splitter, for drawing.
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
    // Of Instrument::elements: where each vertex lies; no_element: on the source or in the plane of best focus. An
    // ideal lens has two vertices: light enters one principal plane and leaves the other, which coincide.
    std::vector<int> elements;
};

// At the reference wavelength, what passes all apertures, each bundle from margin to margin of its cone. Imaging: from
// the axis and the field's edge at +y to the detector. Illumination: from the middle of the source and its lit rim to
// the plane of best focus; a ring light's from the lit segments nearest to the plane of drawing. In the y-z plane of
// the object or source, as far as the elements do not lead them out of it.
std::vector<RoomRay> trace_room_rays(const optics::Instrument& instrument);

} // namespace vkfv::report
