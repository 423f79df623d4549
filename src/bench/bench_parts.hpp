// The parts of --bench, each as bench.hpp tells of it. Those beside validation, stages and hits need the rays of a run.
#pragma once

#include "bench/bench_scene.hpp"

namespace vkfv::bench {

// Every way against the first traversal, each with random numbers of its own; besides a twin whose lobe is wider or
// narrower than the scene's, which has to be found apart.
Json validation(const BenchScene& scene);

Json stages(const BenchScene& scene);
// Sharp and wide lobe, one and four bounces, and the specimen as it comes from an STL of its triangles.
Json forms(const BenchScene& scene);
Json traversal_timings(const BenchScene& scene);
Json hits(const BenchScene& scene);
// Rays by a ray-tracing pipeline beside the traversals, where the device has such pipelines.
Json pipeline(const BenchScene& scene);
Json estimator_timings(const BenchScene& scene);

Json over_rays(const BenchScene& scene);
// The same surface by other numbers of triangles.
Json over_triangles(const BenchScene& scene);
// The library's objectives with the configuration's tube lens and specimen, each pupil filled, with and without the
// beam splitter's glass.
Json over_surfaces(const BenchScene& scene);
Json over_pixels(const BenchScene& scene);

// In turn with the peer, so that whatever else the machine does slows both.
Json beside_peer(const BenchScene& scene);

} // namespace vkfv::bench
