#include "trace/forward_trace.hpp"

#include "spirv/forward_illumination_bvh.h"
#include "spirv/forward_illumination_quadtree.h"
#include "spirv/forward_illumination_ray_query.h"
#include "spirv/forward_imaging_bvh.h"
#include "spirv/forward_imaging_quadtree.h"
#include "spirv/forward_imaging_ray_query.h"

namespace vkfv::trace {

ForwardTrace::ForwardTrace(const DeviceScene& scene, std::uint32_t batch, std::uint32_t stop_illumination,
                           std::uint32_t stop_imaging)
    : PathTrace(scene, batch), survivors_(scene.device, std::size_t{batch} * sizeof(physics::f32::Survivor)),
      survivor_count_(scene.device, sizeof(std::uint32_t)),
      illumination_(scene.device, "forward_illumination",
                    scene.variant(forward_illumination_quadtree, forward_illumination_ray_query,
                                  forward_illumination_bvh),
                    scene.declarations({2, 4, 5}), sizeof(Batch),
                    scene.kernel_constants(stop_illumination)),
      imaging_(scene.device, "forward_imaging",
               scene.variant(forward_imaging_quadtree, forward_imaging_ray_query, forward_imaging_bvh),
               scene.declarations({2, 3, 4, 5}), 0, scene.kernel_constants(stop_imaging)) {}

void ForwardTrace::record(vulkan::Commands& commands, std::uint64_t first, std::uint32_t count,
                                bool timed) const {
    commands.fill_zero(survivor_count_);
    commands.barrier();
    if (timed) {
        commands.timestamp();
    }
    commands.dispatch(illumination_, scene_.bindings({{2, &survivors_}, {4, &fates_}, {5, &survivor_count_}}),
                      make_batch(first, count), (count + paths_per_group - 1) / paths_per_group);
    commands.barrier();
    if (timed) {
        commands.timestamp();
    }
    // The number of survivors is known to the device alone: a fixed grid strides over them.
    const std::uint32_t groups = scene_.software() ? 64 : 4096;
    commands.dispatch(imaging_,
                      scene_.bindings({{2, &survivors_}, {3, &pixels_}, {4, &fates_}, {5, &survivor_count_}}),
                      std::span<const std::byte>{}, groups);
    commands.barrier();
    if (timed) {
        commands.timestamp();
    }
}

} // namespace vkfv::trace
