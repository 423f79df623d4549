// The end of a single path, by which tests compare host and device.
#pragma once

#include <cstdint>

namespace vkfv::trace {

// The end of one path; the kernel probe_paths makes it on a device. x and y (mm) as in physics::Detection: 0 for light
// that did not leave the specimen through the gate, and without meaning for light that a surface or the specimen
// stopped.
struct PathEnd {
    std::uint32_t status = 0;
    std::int32_t surface = -1;
    double x = 0;
    double y = 0;
    double weight = 1; // weight of the light at x and y; with directed scatter that of a path's survivor, if it has one
};

} // namespace vkfv::trace
