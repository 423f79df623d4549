// The backward estimator in double on the host's cores: the reference of the device's.
#pragma once

#include "trace/interface/tracer.hpp"

#include <memory>

namespace vkfv::trace {

// instrument: turned round too.
std::unique_ptr<Tracer> make_host_backward_tracer(const optics::Instrument& instrument,
                                                  const specimen::Specimen& specimen, const TraceOptions& options);

} // namespace vkfv::trace
