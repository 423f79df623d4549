#include "vulkan/pipeline_layout.hpp"

#include "core/messages/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace vkfv::vulkan {

namespace {

// Every Vulkan device supports this number; a larger one would run here and fail elsewhere.
constexpr std::uint32_t portable_push_constant_bytes = 128;

vk::DescriptorType type_of(BindingKind kind) {
    switch (kind) {
    case BindingKind::storage_buffer:
        return vk::DescriptorType::eStorageBuffer;
    case BindingKind::uniform_buffer:
        return vk::DescriptorType::eUniformBuffer;
    case BindingKind::acceleration_structure:
        return vk::DescriptorType::eAccelerationStructureKHR;
    }
    throw std::logic_error("unknown kind of binding");
}

const Binding& binding_at(std::uint32_t slot, std::span<const Binding> bindings, std::string_view name) {
    const auto found = std::ranges::find(bindings, slot, &Binding::slot);
    if (found == bindings.end()) {
        throw std::logic_error(fmt::format("kernel {}: nothing is bound to slot {}", name, slot));
    }
    return *found;
}

void check_range(const Device& device, std::string_view name, const BindingDeclaration& declaration,
                 std::size_t bytes) {
    const vk::PhysicalDeviceLimits limits = device.physical().getProperties().limits;
    const std::uint32_t allowed =
        declaration.kind == BindingKind::uniform_buffer ? limits.maxUniformBufferRange : limits.maxStorageBufferRange;
    if (bytes > allowed) {
        throw DeviceError(
            fmt::format("{} binds at most {} bytes to a kernel, but {} needs {} at slot {}. Use a smaller "
                        "specimen, smaller batches or another device",
                        device.report().name, allowed, name, bytes, declaration.slot));
    }
}

// The part of a buffer that a binding names.
vk::DescriptorBufferInfo range_of(const Device& device, std::string_view name, const BindingDeclaration& declaration,
                                  const Binding& binding, const Buffer& buffer) {
    const std::size_t all = buffer.bytes();
    const bool is_part = binding.bytes > 0;
    const std::size_t bytes = is_part ? binding.bytes : all;
    if (binding.first_byte % binding_alignment != 0 || (!is_part && binding.first_byte > 0) ||
        (is_part && (binding.first_byte > all || bytes > all - binding.first_byte))) {
        throw std::logic_error(fmt::format("kernel {}: slot {} is bound to {} bytes from {} on of {}", name,
                                           declaration.slot, bytes, binding.first_byte, all));
    }
    check_range(device, name, declaration, bytes);
    // The range leaves out the padding, so that a run-time array's length() is right.
    return {buffer.handle(), binding.first_byte, bytes > 0 ? bytes : VK_WHOLE_SIZE};
}

} // namespace

PipelineLayout::PipelineLayout(const Device& device, std::vector<BindingDeclaration> declarations,
                               std::uint32_t push_constant_bytes, vk::ShaderStageFlags stages)
    : declarations_(std::move(declarations)), push_constant_bytes_(push_constant_bytes), stages_(stages) {
    if (push_constant_bytes_ > portable_push_constant_bytes || push_constant_bytes_ % 4 != 0) {
        throw std::logic_error(fmt::format("{} bytes of push constants, expected a multiple of 4 up to {}",
                                           push_constant_bytes_, portable_push_constant_bytes));
    }
    std::vector<vk::DescriptorSetLayoutBinding> slots;
    for (const BindingDeclaration& declaration : declarations_) {
        slots.emplace_back(declaration.slot, type_of(declaration.kind), 1, stages_);
    }
    set_ = vk::raii::DescriptorSetLayout(
        device.handle(),
        vk::DescriptorSetLayoutCreateInfo(vk::DescriptorSetLayoutCreateFlagBits::ePushDescriptorKHR, slots));
    const vk::DescriptorSetLayout set = *set_;
    const vk::PushConstantRange range(stages_, 0, push_constant_bytes_);
    vk::PipelineLayoutCreateInfo info({}, set);
    if (push_constant_bytes_ > 0) {
        info.setPushConstantRanges(range);
    }
    layout_ = vk::raii::PipelineLayout(device.handle(), info);
}

void PipelineLayout::bind(const Device& device, const vk::raii::CommandBuffer& commands, vk::PipelineBindPoint point,
                          std::string_view name, std::span<const Binding> bindings,
                          std::span<const std::byte> push_constants) const {
    if (push_constants.size() != push_constant_bytes_) {
        throw std::logic_error(fmt::format("kernel {}: {} bytes of push constants, expected {}", name,
                                           push_constants.size(), push_constant_bytes_));
    }
    if (bindings.size() != declarations_.size()) {
        throw std::logic_error(
            fmt::format("kernel {}: {} bindings, expected {}", name, bindings.size(), declarations_.size()));
    }
    const std::size_t count = bindings.size();
    // The writes point into these lists, which must not grow afterwards.
    std::vector<vk::DescriptorBufferInfo> buffers(count);
    std::vector<vk::AccelerationStructureKHR> structures(count);
    std::vector<vk::WriteDescriptorSetAccelerationStructureKHR> structure_writes(count);
    std::vector<vk::WriteDescriptorSet> writes(count);
    for (std::size_t i = 0; i < count; ++i) {
        const BindingDeclaration& declaration = declarations_[i];
        const Binding& binding = binding_at(declaration.slot, bindings, name);
        vk::WriteDescriptorSet& write = writes[i];
        write.setDstBinding(declaration.slot).setDescriptorCount(1).setDescriptorType(type_of(declaration.kind));
        const auto* buffer = std::get_if<const Buffer*>(&binding.resource);
        if ((buffer == nullptr) != (declaration.kind == BindingKind::acceleration_structure)) {
            throw std::logic_error(
                fmt::format("kernel {}: slot {} is bound to the wrong kind of resource", name, declaration.slot));
        }
        if (buffer != nullptr) {
            buffers[i] = range_of(device, name, declaration, binding, **buffer);
            write.setBufferInfo(buffers[i]);
        } else {
            structures[i] = std::get<const AccelerationStructure*>(binding.resource)->top_level();
            structure_writes[i].setAccelerationStructures(structures[i]);
            write.setPNext(&structure_writes[i]);
        }
    }
    if (!writes.empty()) {
        commands.pushDescriptorSetKHR(point, *layout_, 0, writes);
    }
    if (!push_constants.empty()) {
        commands.pushConstants<std::byte>(
            *layout_, stages_, 0,
            vk::ArrayProxy<const std::byte>(static_cast<std::uint32_t>(push_constants.size()), push_constants.data()));
    }
}

} // namespace vkfv::vulkan
