// The bindings of a pipeline's shaders: buffers and acceleration structures by push descriptors in set 0, and
// push constants at offset 0.
#pragma once

#include "vulkan/acceleration_structure.hpp"
#include "vulkan/buffer.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

namespace vkfv::vulkan {

// A buffer or a top-level acceleration structure at a binding of set 0.
struct Binding {
    std::uint32_t slot;
    std::variant<const Buffer*, const AccelerationStructure*> resource;
    // bytes > 0: the part of the buffer that begins at first_byte, a multiple of binding_alignment; 0: the whole
    // buffer.
    std::size_t first_byte = 0;
    std::size_t bytes = 0;
};
inline constexpr std::size_t binding_alignment = 256; // largest alignment that Vulkan may require

enum class BindingKind { storage_buffer, uniform_buffer, acceleration_structure };

struct BindingDeclaration {
    std::uint32_t slot;
    BindingKind kind;
};

class PipelineLayout {
  public:
    PipelineLayout() = default;
    // stages: stages that see the bindings and the push constants. The size of the push constants is a multiple of 4
    // and at most 128, which every device supports (throws std::logic_error otherwise). Throws vk::SystemError.
    PipelineLayout(const Device& device, std::vector<BindingDeclaration> declarations,
                   std::uint32_t push_constant_bytes, vk::ShaderStageFlags stages);

    vk::PipelineLayout handle() const { return *layout_; }

    // Binds the arguments of the next command of a pipeline with this layout; name: of that pipeline, for errors. The
    // bindings must name every declared slot, and the push constants must have the declared size (throws
    // std::logic_error otherwise). Throws DeviceError for a buffer larger than a descriptor may span on this device:
    // such a buffer must be reached by its address.
    void bind(const Device& device, const vk::raii::CommandBuffer& commands, vk::PipelineBindPoint point,
              std::string_view name, std::span<const Binding> bindings,
              std::span<const std::byte> push_constants) const;

  private:
    std::vector<BindingDeclaration> declarations_;
    std::uint32_t push_constant_bytes_ = 0;
    vk::ShaderStageFlags stages_;
    vk::raii::DescriptorSetLayout set_{nullptr};
    vk::raii::PipelineLayout layout_{nullptr};
};

} // namespace vkfv::vulkan
