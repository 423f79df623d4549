// Reverses a lens, end for end.
#pragma once

#include "optics/prescriptions/prescription.hpp"

namespace vkfv::optics {

// The lens rotated by 180 degrees about the y axis: light passes its former last surface first. Distances, shapes,
// media, stops, tilts and decentres are those of the same glass seen from the other side. The parts that place the lens
// before its first vertex (coordinate breaks, the distance of a source) are left out.
Prescription turned_round(const Prescription& prescription);

} // namespace vkfv::optics
