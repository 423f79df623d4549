// Specialises kernels by their constants before a driver compiles them.
#pragma once

#include <vulkan/vulkan.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace vkfv::vulkan {

struct SpecializationConstant {
    std::uint32_t id;
    std::uint32_t value; // the bits of an int, uint, float or bool
};

// Specialization constants in the form that a driver takes.
class Specialization {
  public:
    explicit Specialization(std::span<const SpecializationConstant> constants);
    vk::SpecializationInfo info() const; // valid as long as this object

  private:
    std::vector<vk::SpecializationMapEntry> entries_;
    std::vector<std::uint32_t> values_;
};

// The module with these constants in place: excluded code is removed, and calls are inlined. The remaining operations
// are unchanged, so values and roundings are too. Empty if the module cannot be specialised in this way.
std::vector<std::uint32_t> specialised_spirv(std::span<const std::uint32_t> spirv,
                                             std::span<const SpecializationConstant> constants);

} // namespace vkfv::vulkan
