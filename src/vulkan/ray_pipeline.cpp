#include "vulkan/ray_pipeline.hpp"

#include "core/messages/error.hpp"
#include "vulkan/failure.hpp"

#include <fmt/format.h>

#include <utility>

namespace vkfv::vulkan {

namespace {

constexpr vk::ShaderStageFlags all_stages = vk::ShaderStageFlagBits::eRaygenKHR | vk::ShaderStageFlagBits::eMissKHR |
                                            vk::ShaderStageFlagBits::eClosestHitKHR |
                                            vk::ShaderStageFlagBits::eIntersectionKHR;

vk::RayTracingShaderGroupCreateInfoKHR general_group(std::uint32_t stage) {
    return {vk::RayTracingShaderGroupTypeKHR::eGeneral, stage, VK_SHADER_UNUSED_KHR, VK_SHADER_UNUSED_KHR,
            VK_SHADER_UNUSED_KHR};
}

} // namespace

RayPipeline::RayPipeline(const Device& device, std::string name, const RayStages& stages,
                         std::vector<BindingDeclaration> bindings, std::uint32_t push_constant_bytes,
                         std::span<const SpecializationConstant> constants)
    : device_(&device), name_(std::move(name)) {
    if (!device.has_ray_pipelines()) {
        throw DeviceError(fmt::format("{} was not opened for ray-tracing pipelines, which {} needs. Choose another "
                                      "device",
                                      device.report().name, name_));
    }
    try {
        make(stages, std::move(bindings), push_constant_bytes, constants);
        make_table();
    } catch (const vk::SystemError& error) {
        if (may_pass_next_time(error)) {
            throw run_error_of(error, device.report().name);
        }
        throw DeviceError(fmt::format("{} ({}) does not compile the ray-tracing pipeline {}: {}. Update its driver, or "
                                      "choose another device",
                                      device.report().name, device.report().driver, name_, error.what()));
    }
}

void RayPipeline::make(const RayStages& stages, std::vector<BindingDeclaration> bindings,
                       std::uint32_t push_constant_bytes, std::span<const SpecializationConstant> constants) {
    using Stage = vk::ShaderStageFlagBits;
    const Specialization specialization(constants);
    const vk::SpecializationInfo values = specialization.info();
    std::vector<vk::raii::ShaderModule> modules;
    std::vector<vk::PipelineShaderStageCreateInfo> infos;
    for (const auto& [stage, spirv] : {std::pair{Stage::eRaygenKHR, stages.generation},
                                       {Stage::eMissKHR, stages.miss},
                                       {Stage::eClosestHitKHR, stages.closest_hit},
                                       {Stage::eIntersectionKHR, stages.intersection}}) {
        if (!spirv.empty()) {
            vk::ShaderModuleCreateInfo module;
            module.setCodeSize(spirv.size_bytes()).setPCode(spirv.data());
            modules.emplace_back(device_->handle(), module);
            infos.emplace_back(vk::PipelineShaderStageCreateFlags(), stage, *modules.back(), "main", &values);
        }
    }
    const bool boxes = !stages.intersection.empty();
    const std::array groups = {general_group(0), general_group(1),
                               vk::RayTracingShaderGroupCreateInfoKHR(
                                   boxes ? vk::RayTracingShaderGroupTypeKHR::eProceduralHitGroup
                                         : vk::RayTracingShaderGroupTypeKHR::eTrianglesHitGroup,
                                   VK_SHADER_UNUSED_KHR, 2, VK_SHADER_UNUSED_KHR, boxes ? 3 : VK_SHADER_UNUSED_KHR)};
    layout_ = PipelineLayout(*device_, std::move(bindings), push_constant_bytes, all_stages);
    vk::RayTracingPipelineCreateInfoKHR info;
    info.setStages(infos).setGroups(groups).setMaxPipelineRayRecursionDepth(1).setLayout(layout_.handle());
    pipeline_ = vk::raii::Pipeline(device_->handle(), nullptr, device_->pipelines(), info);
}

// Makes a table for each group of shaders: each begins at an address with the alignment that the device requires.
void RayPipeline::make_table() {
    const auto properties =
        device_->physical()
            .getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceRayTracingPipelinePropertiesKHR>()
            .get<vk::PhysicalDeviceRayTracingPipelinePropertiesKHR>();
    const std::size_t handle = properties.shaderGroupHandleSize;
    const vk::DeviceSize alignment = properties.shaderGroupBaseAlignment;
    const auto count = static_cast<std::uint32_t>(regions_.size());
    const std::vector<std::byte> handles =
        pipeline_.getRayTracingShaderGroupHandlesKHR<std::byte>(0, count, count * handle);
    for (std::uint32_t group = 0; group < count; ++group) {
        Buffer& table = tables_.emplace_back(*device_, handle + alignment);
        const vk::DeviceSize first = (alignment - table.address() % alignment) % alignment;
        table.write(std::span(handles).subspan(group * handle, handle), first);
        regions_[group] = vk::StridedDeviceAddressRegionKHR(table.address() + first, handle, handle);
    }
}

void RayPipeline::record(Commands& commands, std::span<const Binding> bindings,
                         std::span<const std::byte> push_constants, std::uint32_t rays) const {
    constexpr vk::PipelineBindPoint point = vk::PipelineBindPoint::eRayTracingKHR;
    commands.handle().bindPipeline(point, *pipeline_);
    layout_.bind(*device_, commands.handle(), point, name_, bindings, push_constants);
    commands.handle().traceRaysKHR(regions_[0], regions_[1], regions_[2], {}, rays, 1, 1);
}

} // namespace vkfv::vulkan
