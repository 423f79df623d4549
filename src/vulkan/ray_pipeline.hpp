// Ray-tracing pipelines (VK_KHR_ray_tracing_pipeline): a ray generation shader, and the shaders that run where its rays
// meet the geometry of an acceleration structure.
#pragma once

#include "vulkan/kernel.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace vkfv::vulkan {

// SPIR-V of each stage; all take the same specialization constants.
struct RayStages {
    std::span<const std::uint32_t> generation;
    std::span<const std::uint32_t> miss;
    std::span<const std::uint32_t> closest_hit;
    std::span<const std::uint32_t> intersection; // for boxes; empty: the geometry is triangles
};

// A ray-tracing pipeline, bound as a Kernel is. Only its generation stage traces rays.
class RayPipeline {
  public:
    // Throws DeviceError where the device was not opened for it (DeviceOptions::ray_pipelines) or does not compile it.
    RayPipeline(const Device& device, std::string name, const RayStages& stages,
                std::vector<BindingDeclaration> bindings, std::uint32_t push_constant_bytes = 0,
                std::span<const SpecializationConstant> constants = {});

    // Runs the generation shader for gl_LaunchIDEXT.x = 0 ... rays - 1. Throws as PipelineLayout::bind().
    void record(Commands& commands, std::span<const Binding> bindings, std::span<const std::byte> push_constants,
                std::uint32_t rays) const;

  private:
    void make(const RayStages& stages, std::vector<BindingDeclaration> bindings, std::uint32_t push_constant_bytes,
              std::span<const SpecializationConstant> constants);
    void make_table();

    const Device* device_;
    std::string name_;
    PipelineLayout layout_;
    vk::raii::Pipeline pipeline_{nullptr};
    std::vector<Buffer> tables_; // one for each group of shaders: generation, miss, hit
    std::array<vk::StridedDeviceAddressRegionKHR, 3> regions_;
};

} // namespace vkfv::vulkan
