// The end of a single path, by which tests compare host and device.
#pragma once

#include <cstdint>

namespace vkfv::trace {

// How one path ended; what the kernel probe_paths gives of the device. x and y (mm) as physics::Detection: 0 for light
// that did not leave the specimen through the gate, and without meaning for light that a surface or the specimen
// stopped.
struct PathEnd {
    std::uint32_t status = 0;
    std::int32_t surface = -1;
    double x = 0;
    double y = 0;
    double weight = 1; // of the light there; with directed scatter of a path's survivor, if it has one
};

} // namespace vkfv::trace
