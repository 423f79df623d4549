#include "trace/forward_trace.hpp"

#include "spirv/forward_illumination_bvh.h"
#include "spirv/forward_illumination_quadtree.h"
#include "spirv/forward_illumination_ray_query.h"
#include "spirv/forward_illumination_specialised_bvh.h"
#include "spirv/forward_illumination_specialised_quadtree.h"
#include "spirv/forward_illumination_specialised_ray_query.h"
#include "spirv/forward_imaging_bvh.h"
#include "spirv/forward_imaging_quadtree.h"
#include "spirv/forward_imaging_ray_query.h"
#include "spirv/forward_imaging_specialised_bvh.h"
#include "spirv/forward_imaging_specialised_quadtree.h"
#include "spirv/forward_imaging_specialised_ray_query.h"

namespace vkfv::trace {

namespace {

std::vector<vulkan::SpecializationConstant> constants_for(const DeviceScene& scene, std::uint32_t stop_after, int first,
                                                          int count) {
    return scene.is_specialised() ? scene.specialised_constants(stop_after, first, count)
                                  : scene.kernel_constants(stop_after);
}

std::span<const std::uint32_t> illumination_variant(const DeviceScene& scene) {
    return scene.is_specialised()
               ? scene.variant(forward_illumination_specialised_quadtree, forward_illumination_specialised_ray_query,
                               forward_illumination_specialised_bvh)
               : scene.variant(forward_illumination_quadtree, forward_illumination_ray_query, forward_illumination_bvh);
}

std::span<const std::uint32_t> imaging_variant(const DeviceScene& scene) {
    return scene.is_specialised()
               ? scene.variant(forward_imaging_specialised_quadtree, forward_imaging_specialised_ray_query,
                               forward_imaging_specialised_bvh)
               : scene.variant(forward_imaging_quadtree, forward_imaging_ray_query, forward_imaging_bvh);
}

} // namespace

ForwardTrace::ForwardTrace(const DeviceScene& scene, std::uint32_t batch, std::uint32_t stop_illumination,
                           std::uint32_t stop_imaging)
    : PathTrace(scene, batch), survivors_(scene.device, std::size_t{batch} * sizeof(physics::f32::Survivor)),
      survivor_count_(scene.device, sizeof(std::uint32_t)),
      illumination_(scene.device, "forward_illumination", illumination_variant(scene), scene.declarations({2, 4, 5}),
                    sizeof(Batch),
                    constants_for(scene, stop_illumination, scene.instrument.constants.illumination_first,
                                  scene.instrument.constants.illumination_count)),
      imaging_(scene.device, "forward_imaging", imaging_variant(scene), scene.declarations({2, 3, 4, 5}), 0,
               constants_for(scene, stop_imaging, scene.instrument.constants.imaging_first,
                             scene.instrument.constants.imaging_count)) {}

void ForwardTrace::record(vulkan::Commands& commands, std::uint64_t first, std::uint32_t count, bool timed) const {
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
    commands.dispatch(imaging_, scene_.bindings({{2, &survivors_}, {3, &pixels_}, {4, &fates_}, {5, &survivor_count_}}),
                      std::span<const std::byte>{}, groups);
    commands.barrier();
    if (timed) {
        commands.timestamp();
    }
}

} // namespace vkfv::trace
