// Compares paths of light without a given sequence in the device's float with those in the host's double.
#pragma once

#include "trace/alike_paths.hpp"
#include "trace/device/device_tracer.hpp"
#include "trace/elements.hpp"
#include "trace/host/host_tracer.hpp"

namespace vkfv::test {

// A path whose random number lies within float rounding of a reflectance parts, and so do all after many turns; so a
// share of fates may differ, and detected ones land within the bound.
inline void expect_same_paths(const optics::Instrument& instrument) {
    const auto specimen = smooth_specimen();
    constexpr std::uint32_t paths = 3000;
    const auto host = trace::host_paths(instrument, specimen, options(trace::Traversal::automatic), 0.002, 7, 0, paths);
    for (const auto traversal : {trace::Traversal::bvh, trace::Traversal::ray_query}) {
        const auto device = trace::device_paths(instrument, specimen, options(traversal), 0.002, 7, 0, paths);
        expect_alike(host, device, 30);
    }
}

} // namespace vkfv::test
