#include "trace/device/nonsequential_trace.hpp"

#include "spirv/nonsequential_bvh.h"
#include "spirv/nonsequential_ray_query.h"

namespace vkfv::trace {

kernels::NonsequentialBatch make_nonsequential_batch(const DeviceScene& scene, std::uint64_t first,
                                                     std::uint32_t count) {
    return {make_batch(first, count), scene.device_specimen.elements_root(), to_float(scene.room.source)};
}

NonsequentialTrace::NonsequentialTrace(const DeviceScene& scene, std::uint32_t batch)
    : PathTrace(scene, batch),
      kernel_(*scene.device, "nonsequential",
              scene.variant(
                  {.quadtree = {}, .software = {}, .ray_query = nonsequential_ray_query, .bvh = nonsequential_bvh}),
              scene.declarations({kernels::BINDING_PIXELS, kernels::BINDING_LEDGER}),
              sizeof(kernels::NonsequentialBatch), scene.kernel_constants()) {}

void NonsequentialTrace::record(vulkan::Commands& commands, const ExposureMemory& exposure, std::uint64_t first,
                                std::uint32_t count, bool timed) const {
    if (timed) {
        commands.timestamp();
    }
    commands.dispatch(
        kernel_, scene_.bindings(exposure, {{kernels::BINDING_PIXELS, &pixels_}, {kernels::BINDING_LEDGER, &fates_}}),
        make_nonsequential_batch(scene_, first, count), (count + paths_per_group - 1) / paths_per_group);
    commands.barrier();
    if (timed) {
        commands.timestamp();
    }
}

} // namespace vkfv::trace
