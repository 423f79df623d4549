// An instrument as the options have its light traced.
#pragma once

#include "optics/instrument/instrument.hpp"
#include "trace/interface/tracer.hpp"

namespace vkfv::trace {

// Where waves come after, its pixels count all of their light, and the filter tells what of it falls on what is
// sensitive. Of light that meets the specimen once the source sends only what the detector can see.
optics::Instrument as_traced(const optics::Instrument& instrument, const TraceOptions& options);

} // namespace vkfv::trace
