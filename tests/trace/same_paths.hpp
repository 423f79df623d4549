// The device's float against the host's double, path by path, of light without a given sequence.
#pragma once

#include "trace/device/device_tracer.hpp"
#include "trace/elements.hpp"
#include "trace/host/host_tracer.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vkfv::test {

// A path whose random number lies within float rounding of a reflectance parts, and so do all after many turns; so a
// share of fates may differ, and detected ones land within the bound.
inline void expect_same_paths(const optics::Instrument& instrument) {
    const auto specimen = smooth_specimen();
    constexpr std::uint32_t paths = 3000;
    const auto host = trace::host_paths(instrument, specimen, options(trace::Traversal::automatic), 0.002, 7, 0, paths);
    for (const auto traversal : {trace::Traversal::bvh, trace::Traversal::ray_query}) {
        const auto device = trace::device_paths(instrument, specimen, options(traversal), 0.002, 7, 0, paths);
        int differing = 0, far = 0, detected = 0;
        for (std::uint32_t k = 0; k < paths; ++k) {
            const bool same = host[k].status == device[k].status && host[k].surface == device[k].surface;
            differing += same ? 0 : 1;
            if (same && host[k].status == PATH_DETECTED) {
                ++detected;
                far += std::hypot(host[k].x - device[k].x, host[k].y - device[k].y) > 1e-3 ? 1 : 0; // 1 um
            }
        }
        EXPECT_GT(detected, 30);
        EXPECT_LE(differing, static_cast<int>(paths / 500));
        EXPECT_LE(far, 2);
    }
}

} // namespace vkfv::test
