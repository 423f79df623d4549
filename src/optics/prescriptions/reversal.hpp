// A lens turned round.
#pragma once

#include "optics/prescriptions/prescription.hpp"

namespace vkfv::optics {

// The lens turned by 180 degrees about the y axis: light passes what was its last surface first. Distances, shapes,
// media, stops, tilts and decentres are those of the same glass seen from the other side. What stood before the first
// vertex (its coordinate breaks, the distance of a source) places the lens and is left out.
Prescription turned_round(const Prescription& prescription);

} // namespace vkfv::optics
