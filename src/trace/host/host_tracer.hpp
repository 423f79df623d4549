// The reference: the same paths in double on the host's cores. It is slow, for tests and for machines without Vulkan.
#pragma once

#include "trace/interface/path_end.hpp"
#include "trace/interface/tracer.hpp"

#include <memory>
#include <span>

namespace vkfv::trace {

std::unique_ptr<Tracer> make_host_tracer(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                                         const TraceOptions& options);

// The ends of the paths first ... first + count - 1 of one exposure. source_scale (about 1) scales the source's radius
// and emission: by it a test finds out whether a path lies within rounding of an edge.
std::vector<PathEnd> host_paths(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                                const TraceOptions& options, FocalPosition position, std::uint32_t image,
                                std::uint64_t first, std::uint64_t count, double source_scale = 1.0);

} // namespace vkfv::trace
