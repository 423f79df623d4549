// The backward estimator in double on the host's cores: the reference for the device's.
#pragma once

#include "trace/interface/tracer.hpp"

#include <memory>

namespace vkfv::trace {

// Makes the tracer; the instrument must have a reversed form (turned) too.
std::unique_ptr<Tracer> make_host_backward_tracer(const optics::Instrument& instrument,
                                                  const specimen::Specimen& specimen, const TraceOptions& options);

} // namespace vkfv::trace
