// The trace on a Vulkan device, in float: the two halves of the forward path as two kernels.
#pragma once

#include "trace/interface/path_end.hpp"
#include "trace/interface/tracer.hpp"

#include <memory>
#include <vector>

namespace vkfv::trace {

// Makes a tracer on a device. Throws DeviceError (no usable device, too little memory) or InputError (a traversal that
// the specimen or the device does not admit).
std::unique_ptr<Tracer> make_device_tracer(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                                           const TraceOptions& options);

// The ends of single paths, as host_paths() gives them; for tests.
std::vector<PathEnd> device_paths(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                                  const TraceOptions& options, FocalPosition position, std::uint32_t image,
                                  std::uint64_t first, std::uint32_t count);

} // namespace vkfv::trace
