// Whether an instrument has a reversed form for the backward estimator (turned_round()).
#pragma once

#include "optics/instrument/instrument.hpp"

namespace vkfv::optics {

// True if the backward estimator can follow this light. A ring light over a cover glass needs a glass that is denser
// than the medium below the objective, over the whole spectrum.
bool can_turn_round(const InstrumentDescription& description);

} // namespace vkfv::optics
