// An image in the light of several sources: the sum of the images in the light of each. Each source has its own rays
// and its own random numbers, so that the sum's error is that of independent parts.
#pragma once

#include "trace/device_exposures.hpp"
#include "trace/tracer.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace vkfv::trace {

// The rays of each source, in proportion to what is given for it: `rays` in all, but at least one each.
std::vector<std::uint64_t> rays_of_sources(std::uint64_t rays, std::span<const double> shares);

// What traces one of an instrument's lights: the instrument without the others, and the options with its own rays and
// seed, and its share of a device's memory. Forward rays carry the same power of all sources, as far as they are aimed;
// backward each source is looked for by as many. Of an instrument with one light: what was given.
struct OneLight {
    optics::Instrument instrument;
    TraceOptions options;
};
std::vector<OneLight> one_by_one(const optics::Instrument& instrument, const TraceOptions& options);

// As one; of a single one itself.
TracerIdentity mixed_identity(const std::vector<TracerIdentity>& identities);

// TracerIdentity::instrument of who traces this instrument with these options, on any device.
std::string traced_digest(const optics::Instrument& instrument, const TraceOptions& options);

// tracers: of each light, at least two.
std::unique_ptr<Tracer> mix_on_host(std::vector<std::unique_ptr<Tracer>> tracers);
// On one device.
std::unique_ptr<DeviceExposures> mix_on_device(std::vector<std::unique_ptr<DeviceExposures>> tracers);

} // namespace vkfv::trace
