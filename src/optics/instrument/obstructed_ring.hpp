// Ring lights that the objective stands in the way of, which the trace does not see: its light passes the objective by.
#pragma once

#include "optics/instrument/instrument.hpp"

#include <vector>

namespace vkfv::optics {

// A warning for each ring light of the description whose band, or whose light on the way to the middle of the field,
// meets the objective: the body of revolution over the rims of its lenses, straight between them. A mount is wider
// still. `instrument` was assembled of the description.
std::vector<Warning> warnings_of_obstructed_rings(const InstrumentDescription& description,
                                                  const Instrument& instrument);

} // namespace vkfv::optics
