// The host's tracer of an instrument with several sources.
#pragma once

#include "trace/interface/tracer.hpp"

#include <memory>
#include <vector>

namespace vkfv::trace {

// The tracer of all sources. tracers: one for each source, at least two.
std::unique_ptr<Tracer> mix_on_host(std::vector<std::unique_ptr<Tracer>> tracers);

} // namespace vkfv::trace
