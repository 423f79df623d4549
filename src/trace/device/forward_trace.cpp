#include "trace/device/forward_trace.hpp"

#include "spirv/forward_illumination_bvh.h"
#include "spirv/forward_illumination_quadtree.h"
#include "spirv/forward_illumination_ray_query.h"
#include "spirv/forward_illumination_software.h"
#include "spirv/forward_illumination_specialised_bvh.h"
#include "spirv/forward_illumination_specialised_quadtree.h"
#include "spirv/forward_illumination_specialised_ray_query.h"
#include "spirv/forward_illumination_specialised_software.h"
#include "spirv/forward_imaging_bvh.h"
#include "spirv/forward_imaging_quadtree.h"
#include "spirv/forward_imaging_ray_query.h"
#include "spirv/forward_imaging_software.h"
#include "spirv/forward_imaging_specialised_bvh.h"
#include "spirv/forward_imaging_specialised_quadtree.h"
#include "spirv/forward_imaging_specialised_ray_query.h"
#include "spirv/forward_imaging_specialised_software.h"

namespace vkfv::trace {

using kernels::BINDING_EMISSION_CELLS;
using kernels::BINDING_EMISSION_FIRST;
using kernels::BINDING_LEDGER;
using kernels::BINDING_PIXELS;
using kernels::BINDING_SURVIVOR_COUNT;
using kernels::BINDING_SURVIVORS;

namespace {

std::vector<vulkan::SpecializationConstant> constants_for(const DeviceScene& scene, std::uint32_t stop_after, int first,
                                                          int count) {
    auto all = scene.specialised ? scene.specialised_constants(first, count) : scene.kernel_constants();
    all.push_back({kernels::CONSTANT_STOP_AFTER, stop_after});
    return all;
}

std::span<const std::uint32_t> illumination_variant(const DeviceScene& scene) {
    return scene.variant(scene.specialised ? KernelVariants{.quadtree = forward_illumination_specialised_quadtree,
                                                            .software = forward_illumination_specialised_software,
                                                            .ray_query = forward_illumination_specialised_ray_query,
                                                            .bvh = forward_illumination_specialised_bvh}
                                           : KernelVariants{.quadtree = forward_illumination_quadtree,
                                                            .software = forward_illumination_software,
                                                            .ray_query = forward_illumination_ray_query,
                                                            .bvh = forward_illumination_bvh});
}

std::span<const std::uint32_t> imaging_variant(const DeviceScene& scene) {
    return scene.variant(scene.specialised ? KernelVariants{.quadtree = forward_imaging_specialised_quadtree,
                                                            .software = forward_imaging_specialised_software,
                                                            .ray_query = forward_imaging_specialised_ray_query,
                                                            .bvh = forward_imaging_specialised_bvh}
                                           : KernelVariants{.quadtree = forward_imaging_quadtree,
                                                            .software = forward_imaging_software,
                                                            .ray_query = forward_imaging_ray_query,
                                                            .bvh = forward_imaging_bvh});
}

std::vector<vulkan::SpecializationConstant> illumination_constants(const DeviceScene& scene, std::uint32_t stop_after) {
    const auto& instrument = scene.instrument.constants;
    auto all = constants_for(scene, stop_after, instrument.illumination_first, instrument.illumination_count);
    const auto polynomials = scene.illumination_polynomials();
    all.insert(all.end(), polynomials.begin(), polynomials.end());
    return all;
}

} // namespace

ForwardTrace::ForwardTrace(const DeviceScene& scene, std::uint32_t batch, std::uint32_t stop_illumination,
                           std::uint32_t stop_imaging)
    : PathTrace(scene, batch), survivors_(*scene.device, std::size_t{batch} * sizeof(physics::f32::Survivor)),
      survivor_count_(*scene.device, sizeof(std::uint32_t)),
      illumination_(*scene.device, "forward_illumination", illumination_variant(scene),
                    scene.declarations({BINDING_SURVIVORS, BINDING_LEDGER, BINDING_SURVIVOR_COUNT,
                                        BINDING_EMISSION_CELLS, BINDING_EMISSION_FIRST}),
                    sizeof(kernels::Batch), illumination_constants(scene, stop_illumination)),
      imaging_(*scene.device, "forward_imaging", imaging_variant(scene),
               scene.declarations({BINDING_SURVIVORS, BINDING_PIXELS, BINDING_LEDGER, BINDING_SURVIVOR_COUNT}), 0,
               constants_for(scene, stop_imaging, scene.instrument.constants.imaging_first,
                             scene.instrument.constants.imaging_count)) {}

void ForwardTrace::record(vulkan::Commands& commands, const ExposureMemory& exposure, std::uint64_t first,
                          std::uint32_t count, bool timed) const {
    commands.fill_zero(survivor_count_);
    commands.barrier();
    if (timed) {
        commands.timestamp();
    }
    commands.dispatch(illumination_,
                      scene_.bindings(exposure, {{BINDING_SURVIVORS, &survivors_},
                                                 {BINDING_LEDGER, &fates_},
                                                 {BINDING_SURVIVOR_COUNT, &survivor_count_},
                                                 {BINDING_EMISSION_CELLS, &scene_.emission->given},
                                                 {BINDING_EMISSION_FIRST, &scene_.emission->first_paths}}),
                      make_batch(first, count), (count + paths_per_group - 1) / paths_per_group);
    commands.barrier();
    if (timed) {
        commands.timestamp();
    }
    // The number of survivors is known to the device alone: a fixed grid strides over them.
    const std::uint32_t groups = scene_.software() ? 64 : 4096;
    commands.dispatch(imaging_,
                      scene_.bindings(exposure, {{BINDING_SURVIVORS, &survivors_},
                                                 {BINDING_PIXELS, &pixels_},
                                                 {BINDING_LEDGER, &fates_},
                                                 {BINDING_SURVIVOR_COUNT, &survivor_count_}}),
                      std::span<const std::byte>{}, groups);
    commands.barrier();
    if (timed) {
        commands.timestamp();
    }
}

} // namespace vkfv::trace
