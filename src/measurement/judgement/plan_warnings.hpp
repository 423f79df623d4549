// Warnings about a configuration's plan, before any light is traced.
#pragma once

#include "configuration/configuration.hpp"
#include "core/messages/warning.hpp"
#include "measurement/scene/specimen_view.hpp"
#include "optics/instrument/instrument.hpp"

#include <vector>

namespace vkfv::measurement {

// The warnings of a stack's scan and evaluation: an assumed pitch far from the true one; a scan inside the depth of
// field, a scan with coarse steps, a scan that does not hold the specimen or its curved image; a window as wide as the
// image; an average along z at its end; images or an evaluation that exceed this machine's memory. The instrument is
// the configuration's, `relief` the part of the specimen that its detector sees. Without [scan] there are only warnings
// of the pitch and of memory.
std::vector<Warning> plan_warnings(const Configuration& configuration, const optics::Instrument& instrument,
                                   const Relief& relief);

// The depth of focus, mm: that of the optics, n lambda / NA^2, or that of the pixels, n e / NA with the pitch e in the
// object, whichever is larger.
double depth_of_focus(const optics::FirstOrder& first_order);

// The most memory, in bytes, that the evaluation of the configuration's stack takes where it is done (StackEvaluator,
// topography.hpp).
double evaluation_bytes(const Configuration& configuration, const optics::Instrument& instrument);

} // namespace vkfv::measurement
