#include "vulkan/specialised_spirv.hpp"

#include <spirv-tools/optimizer.hpp>

#include <unordered_map>

namespace vkfv::vulkan {

Specialization::Specialization(std::span<const SpecializationConstant> constants) {
    for (const SpecializationConstant& constant : constants) {
        entries_.emplace_back(constant.id, static_cast<std::uint32_t>(values_.size() * sizeof(std::uint32_t)),
                              sizeof(std::uint32_t));
        values_.push_back(constant.value);
    }
}

vk::SpecializationInfo Specialization::info() const {
    return {static_cast<std::uint32_t>(entries_.size()), entries_.data(), values_.size() * sizeof(std::uint32_t),
            values_.data()};
}

std::vector<std::uint32_t> specialised_spirv(std::span<const std::uint32_t> spirv,
                                             std::span<const SpecializationConstant> constants) {
    std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> values;
    for (const SpecializationConstant& constant : constants) {
        values.emplace(constant.id, std::vector{constant.value});
    }
    spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_2);
    // Warnings about parts that a pass leaves unchanged are ignored, as the driver accepts these too; without a
    // consumer they would be exceptions.
    optimizer.SetMessageConsumer([](spv_message_level_t, const char*, const spv_position_t&, const char*) {});
    optimizer.RegisterPass(spvtools::CreateSetSpecConstantDefaultValuePass(values))
        .RegisterPass(spvtools::CreateFreezeSpecConstantValuePass())
        .RegisterPass(spvtools::CreateFoldSpecConstantOpAndCompositePass())
        .RegisterPass(spvtools::CreateUnifyConstantPass())
        // Code that does not run is removed first, by constants through all calls: then there is little to inline.
        .RegisterPass(spvtools::CreateCCPPass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateAggressiveDCEPass())
        .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass())
        .RegisterPass(spvtools::CreateInlineExhaustivePass())
        .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass());
    spvtools::OptimizerOptions options;
    options.set_run_validator(false); // the build has validated the module
    std::vector<std::uint32_t> specialised;
    if (!optimizer.Run(spirv.data(), spirv.size(), &specialised, options)) {
        return {};
    }
    return specialised;
}

} // namespace vkfv::vulkan
