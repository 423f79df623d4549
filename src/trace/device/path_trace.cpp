#include "trace/device/path_trace.hpp"

#include <algorithm>

namespace vkfv::trace {

std::uint32_t suitable_batch(const DeviceScene& scene, const TraceOptions& options) {
    const std::uint64_t largest =
        std::min<std::uint64_t>(scene.device->report().max_storage_buffer_bytes / sizeof(physics::f32::Survivor),
                                // Vulkan guarantees 65535 workgroups a dispatch
                                std::uint64_t{65535} * workgroup_size * rays_per_invocation);
    const std::uint64_t wanted = options.batch > 0  ? options.batch
                                 : scene.software() ? std::uint64_t{1} << 20
                                                    : std::uint64_t{1} << 25;
    return static_cast<std::uint32_t>(
        std::max<std::uint64_t>(1, std::min({wanted, largest, options.rays}) / options.batch_divisor));
}

} // namespace vkfv::trace
