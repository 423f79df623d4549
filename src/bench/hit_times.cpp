#include "bench/hit_times.hpp"

#include "spirv/time_hits_bvh.h"
#include "spirv/time_hits_quadtree.h"
#include "spirv/time_hits_ray_query.h"
#include "trace/device/device_specimen.hpp"
#include "trace/interface/device_records.hpp"
#include "vulkan/device.hpp"
#include "vulkan/kernel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <span>
#include <vector>

namespace vkfv::bench {

namespace {

constexpr std::uint32_t group_size = 128;
constexpr std::uint32_t rays_per_invocation = 16;
constexpr std::uint32_t kept_starts = 1u << 18;
constexpr double warm_up_seconds = 0.5; // a GPU's idle clocks rise in this time

} // namespace

HitTimes time_hits(const specimen::Specimen& specimen, const trace::TraceOptions& options, double numerical_aperture,
                   HitOrder order, int runs) {
    const vulkan::Device device(vulkan::DeviceOptions{options.device});
    const auto [traversal, reason] = trace::choose_traversal(device.report(), specimen, options.traversal);
    const trace::DeviceSpecimen on_device(device, specimen, traversal);
    kernels::Parameters parameters{};
    parameters.specimen = on_device.record(1);
    vulkan::Buffer uniform(device, sizeof parameters, vulkan::Buffer::Memory::host);
    uniform.write_values(std::span<const kernels::Parameters>(&parameters, 1));
    const vulkan::Buffer met(device, sizeof(std::uint64_t));
    const vulkan::Buffer starts(device, std::size_t{kept_starts} * sizeof(kernels::TimedStart));

    auto declarations = on_device.declarations();
    declarations.push_back({kernels::BINDING_PARAMETERS, vulkan::BindingKind::uniform_buffer});
    declarations.push_back({kernels::BINDING_FOUND, vulkan::BindingKind::storage_buffer});
    declarations.push_back({kernels::BINDING_GIVEN, vulkan::BindingKind::storage_buffer});
    auto bindings = on_device.bindings();
    bindings.push_back({kernels::BINDING_PARAMETERS, &uniform});
    bindings.push_back({kernels::BINDING_FOUND, &met});
    bindings.push_back({kernels::BINDING_GIVEN, &starts});
    const std::span<const std::uint32_t> spirv =
        traversal == trace::Traversal::ray_query ? std::span<const std::uint32_t>(time_hits_ray_query)
        : traversal == trace::Traversal::bvh     ? std::span<const std::uint32_t>(time_hits_bvh)
                                                 : std::span<const std::uint32_t>(time_hits_quadtree);
    const auto kernel_for = [&](std::uint32_t way) {
        auto constants = on_device.constants();
        constants.push_back({kernels::CONSTANT_HITS_WAY, way});
        return vulkan::Kernel(device, "time_hits", spirv, declarations, sizeof(kernels::TimedHits), constants);
    };
    const vulkan::Kernel kernel = kernel_for(order == HitOrder::leaving ? kernels::HITS_LEAVE : kernels::HITS_ARRIVE);

    const bool software = vulkan::is_software(device.report());
    kernels::TimedHits batch{};
    batch.count = options.batch > 0 ? static_cast<std::uint32_t>(options.batch) : software ? 1u << 20 : 1u << 28;
    batch.seed = options.seed;
    batch.aperture = static_cast<float>(numerical_aperture);
    // Strata of 32 rays: as many as the rays fill once.
    batch.strata_bits = order == HitOrder::morton ? (std::bit_width(std::max(batch.count / 32, 1u)) - 1) / 2 : 0;
    if (order == HitOrder::leaving) {
        const vulkan::Kernel recording = kernel_for(kernels::HITS_RECORD);
        kernels::TimedHits first = batch;
        first.count = kept_starts;
        vulkan::Commands commands(device);
        commands.dispatch(recording, bindings, first, kept_starts / group_size);
        commands.submit_and_wait();
    }

    const std::uint32_t per_group = group_size * rays_per_invocation;
    // Vulkan guarantees 65535 workgroups a dispatch.
    const std::uint32_t groups = std::min((batch.count + per_group - 1) / per_group, 65535u);
    const auto run = [&] {
        vulkan::Commands commands(device, 2);
        commands.fill_zero(met);
        commands.barrier();
        commands.timestamp();
        commands.dispatch(kernel, bindings, batch, groups);
        commands.barrier();
        commands.timestamp();
        commands.submit_and_wait();
        return commands.seconds()[1];
    };
    for (double warm = run(); !software && warm < warm_up_seconds;) {
        warm += run();
    }
    std::vector<double> seconds;
    for (int k = 0; k < runs; ++k) {
        seconds.push_back(run());
    }
    std::ranges::sort(seconds);
    const double median = seconds[seconds.size() / 2];
    HitTimes result;
    result.description = fmt::format("{}; traversal {}", device.choice(), reason);
    result.rays = batch.count;
    result.hits_per_second = batch.count / median;
    result.spread = (seconds.back() - seconds.front()) / median;
    result.share_met = static_cast<double>(met.read_values<std::uint64_t>(1)[0]) / batch.count;
    return result;
}

} // namespace vkfv::bench
