// The parts of vkfv bench, described in bench.hpp. All except validation, stages, hits and pipeline need the rays of a
// run.
#pragma once

#include "bench/bench_scene.hpp"

namespace vkfv::bench {

// Compares every way with the first traversal, each with random numbers of its own; and with a wrong twin, whose lobe
// is wider or narrower than the scene's and which has to be detected.
Json validation(const BenchScene& scene);

Json stages(const BenchScene& scene);
// Times a sharp and a wide lobe, one and four bounces, and the specimen as read from an STL of its triangles.
Json forms(const BenchScene& scene);
Json traversal_timings(const BenchScene& scene);
Json hits(const BenchScene& scene);
// Compares a ray-tracing pipeline with the traversals, if the device has such pipelines.
Json pipeline(const BenchScene& scene);
Json estimator_timings(const BenchScene& scene);

Json over_rays(const BenchScene& scene);
// Times the same surface with other numbers of triangles.
Json over_triangles(const BenchScene& scene);
// Times the library's objectives with the configuration's tube lens and specimen, each pupil filled, with and without
// the beam splitter's glass.
Json over_surfaces(const BenchScene& scene);
Json over_pixels(const BenchScene& scene);

// Times runs in turn with the peer, so that other load on the machine slows both.
Json beside_peer(const BenchScene& scene);

} // namespace vkfv::bench
