// An image in the light of several sources is the sum of the images in the light of each. Each source has its own rays
// and its own random numbers, so the sum's variance is the sum of the variances.
#pragma once

#include "trace/interface/tracer.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace vkfv::trace {

// The number of rays of each source, in proportion to `shares`: `rays` in all, but at least one each.
std::vector<std::uint64_t> rays_of_sources(std::uint64_t rays, std::span<const double> shares);

// One source of an instrument and the options for it: the instrument without its other sources, and options with the
// source's own rays, seed and share of a device's memory. Forward rays of all sources carry the same power, as far as
// they are aimed; backward each source gets the same number of paths. For an instrument with one source both are
// returned unchanged.
struct OneLight {
    optics::Instrument instrument;
    TraceOptions options;
};
std::vector<OneLight> one_by_one(const optics::Instrument& instrument, const TraceOptions& options);

// The combined identity of the tracers of all sources; a single identity is returned unchanged.
TracerIdentity mixed_identity(const std::vector<TracerIdentity>& identities);

// TracerIdentity::instrument of a tracer of this instrument with these options, on any device.
std::string traced_digest(const optics::Instrument& instrument, const TraceOptions& options);

// Identity, description and filters of a mixture, from the tracers of its sources (Tracer or a class derived from it).
template <class AnyTracer>
TracerIdentity identity_of(const std::vector<std::unique_ptr<AnyTracer>>& tracers) {
    std::vector<TracerIdentity> identities;
    for (const auto& tracer : tracers) {
        identities.push_back(tracer->identity());
    }
    return mixed_identity(identities);
}

template <class AnyTracer>
std::string description_of(const std::vector<std::unique_ptr<AnyTracer>>& tracers) {
    return fmt::format("{}; {} sources", tracers.front()->description(), tracers.size());
}

template <class AnyTracer>
std::vector<optics::PupilFilter> all_filters_of(const std::vector<std::unique_ptr<AnyTracer>>& tracers) {
    std::vector<optics::PupilFilter> all;
    for (const auto& tracer : tracers) {
        std::ranges::copy(tracer->pupil_filters(), std::back_inserter(all));
    }
    return all;
}

} // namespace vkfv::trace
