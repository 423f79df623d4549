// The instrument changed as the trace needs it.
#pragma once

#include "optics/instrument/instrument.hpp"
#include "trace/interface/tracer.hpp"

namespace vkfv::trace {

// With wave imaging, pixels collect over their full area; the filter applies the fill factor. If light meets the
// specimen only once, the source sends only light that the detector can see.
optics::Instrument as_traced(const optics::Instrument& instrument, const TraceOptions& options);

} // namespace vkfv::trace
