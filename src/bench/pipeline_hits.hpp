// Compares a device's own traversal of an acceleration structure with vkfv's traversals, by a ray-tracing pipeline,
// which data-centre GPUs have though they have no ray query.
#pragma once

#include "specimen/specimen.hpp"
#include "trace/interface/tracer.hpp"

#include <cstdint>
#include <string>

namespace vkfv::bench {

// Differences between two traversals of the same rays. A difference counts as rounding if both points lie within 1 nm
// across the surface, as those of a grazing ray do whose heights are farther apart; or if, for both traversals, the
// host's reference in double agrees with that traversal for the ray or one of its 26 neighbours that are moved by 1 nm
// along the axes: the ray grazes, or comes within 1 nm of an edge.
struct HitDifferences {
    std::uint64_t rays = 0;
    std::uint64_t both = 0;          // met by both
    std::uint64_t one_alone = 0;     // met by only one
    std::uint64_t apart = 0;         // met by both, at heights more than 1 nm apart
    std::uint64_t unexplained = 0;   // differences among one_alone and apart that are not rounding
    double largest_height_apart = 0; // mm, of rays met by both that are not apart
};

// Compares both traversals. Half of the rays come from the top plane, uniform over the footprint and over a pupil of NA
// 0.4; the others leave the points that these meet, as a Lambertian surface sends them. beside: the specimen for vkfv's
// traversal, quadtree or bvh; the same one, except in a test of the comparison. seed: of the rays. Throws InputError
// where the traversal does not take the specimen, DeviceError where the device has no ray-tracing pipelines.
HitDifferences compare_pipeline_hits(const specimen::Specimen& specimen, const specimen::Specimen& beside,
                                     trace::Traversal traversal, const std::string& device_selector, std::uint64_t rays,
                                     std::uint64_t seed);

} // namespace vkfv::bench
