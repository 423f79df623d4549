// Compares the ends of paths by the host in double with those by the device in float.
#pragma once

#include "trace/host/host_tracer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace vkfv::test {

// A share of 1/500 of the paths may have other fates on the device; more than `fewest` are detected by both, and two of
// these may land farther than 1 um apart.
inline void expect_alike(const std::vector<trace::PathEnd>& host, const std::vector<trace::PathEnd>& device,
                         int fewest) {
    int differing = 0, far = 0, detected = 0;
    for (std::size_t k = 0; k < host.size(); ++k) {
        const bool same = host[k].status == device[k].status && host[k].surface == device[k].surface;
        differing += same ? 0 : 1;
        if (same && host[k].status == physics::f64::PATH_DETECTED) {
            ++detected;
            far += std::hypot(host[k].x - device[k].x, host[k].y - device[k].y) > 1e-3 ? 1 : 0; // 1 um
        }
    }
    EXPECT_GT(detected, fewest);
    EXPECT_LE(differing, static_cast<int>(host.size() / 500));
    EXPECT_LE(far, 2);
}

} // namespace vkfv::test
